# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What the page needs beyond viser's own elements: arrow keys that drive, and buttons as a pad.

viser has no element for keys that are held, so a script presses the buttons of the pad on their
behalf. viser puts an element's HTML into the page as it is but does not run scripts in it; an
image that cannot be loaded does run its `onerror`.
"""

from html import escape
import json

from husky_sim.view.pad import Direction

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
@media (max-width: 600px) { .husky-legend { display: none; } }
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
  const arrange = () => {
    for (const sign in areas) {
      const b = button(sign);
      if (!b || !b.parentElement) continue;
      b.parentElement.style.gridArea = areas[sign];
      b.parentElement.parentElement.classList.add('husky-pad');
    }
    const stop = [...document.querySelectorAll('button')]
      .find((b) => STOPS.includes(b.textContent.trim()));
    if (stop) stop.classList.add('husky-stop');
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
        f'<style>{_STYLE}</style>'
        f'<img src="data:," alt="" style="display:none" onerror="{escape(script, quote=True)}">'
    )
