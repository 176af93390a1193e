# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What the page needs beyond viser's own elements: keys that drive, a pad, and room on a phone.

viser has no element for keys that are held, so a script presses the buttons of the pad on their
behalf. viser puts an element's HTML into the page as it is but does not run scripts in it; an
image that cannot be loaded does run its `onerror`.
"""

from html import escape
import json

from husky_view.picture.pad import Direction

_KEYS = {
    'ArrowUp': Direction.FORWARD,
    'ArrowLeft': Direction.LEFT,
    'ArrowRight': Direction.RIGHT,
    'ArrowDown': Direction.BACK,
}
_AREAS = {
    Direction.FORWARD: 'up',
    Direction.LEFT: 'left',
    Direction.RIGHT: 'right',
    Direction.BACK: 'down',
}

_STYLE = """
.husky-pad { display: grid !important; gap: 0.3em; padding: 0 0.6em 0.4em;
  grid-template-areas: ". up ." "left down right"; grid-template-columns: 1fr 1fr 1fr; }
.husky-pad > * { margin: 0 !important; padding: 0 !important; touch-action: none; }
.husky-pad button { height: 2.6em !important; touch-action: none; user-select: none;
  -webkit-user-select: none; }
@media (max-width: 576px) {
  .husky-legend { display: none; }
  [style*="width: 20em"]:has(.husky-page) { width: 100% !important; }
  [style*="position: fixed"]:has(.husky-page) { max-height: 52% !important; }
}
.husky-stop button, button.husky-stop { height: 3.2em !important; font-size: 1.15em; }
"""

_SCRIPT = """
if (!window.huskyPad) {
  const keys = KEYS, areas = AREAS;
  const button = (sign) => [...document.querySelectorAll('button')]
    .find((b) => b.textContent.trim() === sign);
  const send = (sign, type) => {
    const b = button(sign);
    if (b) b.dispatchEvent(new PointerEvent(type,
      {bubbles: true, cancelable: true, button: 0, pointerId: 1, pointerType: 'mouse'}));
  };
  const held = new Set();
  const release = (key) => {
    if (!held.delete(key)) return;
    send(keys[key], 'pointerup');
    send(keys[key], 'click');
  };
  const typing = (e) => e.target.closest &&
    e.target.closest('input, textarea, select, [role=slider], [role=tab], [contenteditable]');
  window.addEventListener('keydown', (e) => {
    if (!(e.key in keys) || e.ctrlKey || e.altKey || e.metaKey || typing(e)) return;
    if (!button(keys[e.key])) return;
    e.preventDefault(); e.stopImmediatePropagation();
    if (!held.has(e.key)) { held.add(e.key); send(keys[e.key], 'pointerdown'); }
  }, true);
  window.addEventListener('keyup', (e) => {
    if (held.has(e.key)) { e.preventDefault(); e.stopImmediatePropagation(); release(e.key); }
  }, true);
  const releaseAll = () => [...held].forEach(release);
  window.addEventListener('blur', releaseAll);
  window.addEventListener('pagehide', releaseAll);
  document.addEventListener('visibilitychange', releaseAll);
  const makeRoom = () => {
    const canvas = [...document.querySelectorAll('canvas')].find((c) => c.clientWidth > 100);
    let panel = document.querySelector('.husky-page');
    while (panel && getComputedStyle(panel).position !== 'fixed') panel = panel.parentElement;
    if (!canvas || !panel) return;
    const over = window.matchMedia('(max-width: 576px)').matches;
    const height = over ? `${Math.round(panel.getBoundingClientRect().top)}px` : '100%';
    const box = canvas.parentElement.parentElement;
    if (box.style.height !== height) box.style.height = height;
  };
  const arrange = () => {
    makeRoom();
    for (const sign in areas) {
      const b = button(sign);
      if (!b || !b.parentElement) continue;
      if (b.parentElement.style.gridArea) continue;
      b.parentElement.style.gridArea = areas[sign];
      b.parentElement.parentElement.classList.add('husky-pad');
    }
    const stop = [...document.querySelectorAll('button')]
      .find((b) => STOPS.includes(b.textContent.trim()));
    if (stop) stop.classList.add('husky-stop');
    // To be without a graphics processor is nothing to warn of here; and it hides the scene.
    for (const note of document.querySelectorAll('.mantine-Notification-root'))
      if (note.textContent.startsWith('Software WebGL')) note.querySelector('button').click();
  };
  arrange();
  window.huskyPad = setInterval(arrange, 100);
}
"""

STOP, GO = 'STOP', 'Release the stop'


def page_html() -> str:
    """Return an element without looks that makes the page what it has to be."""
    script = (
        _SCRIPT.replace('KEYS', json.dumps({key: d.sign for key, d in _KEYS.items()}))
        .replace('AREAS', json.dumps({d.sign: area for d, area in _AREAS.items()}))
        .replace('STOPS', json.dumps([STOP, GO]))
    )
    return (
        f'<style>{_STYLE}</style><span class="husky-page"></span>'
        f'<img src="data:," alt="" style="display:none" onerror="{escape(script, quote=True)}">'
    )
