# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What the page has beyond viser's own elements: keys that drive, a pad, room on a phone, figures.

viser has no element for keys that are held, so a script presses the buttons of the pad instead.
"""

from collections.abc import Collection, Sequence
from enum import Enum
from html import escape
import json

import viser
from viser._messages import RunJavascriptMessage

from husky_view.picture.palette import css, DOTS, LEGEND, Rgb, SKY_ABOVE, SKY_BELOW
from husky_view.picture.pointer import POINTER_SCRIPT

STOP, RELEASE = 'STOP', 'Release the stop'
PLAY = 'Play'

FREE, FOLLOW, TOP = 'Free', 'Follow', 'Top'
PRESETS = (FREE, FOLLOW, TOP)
"""Of the camera of a tab; the first one holds at the beginning."""

ON_TOP, SHADOWS, FIXED = '/on_top/', '/shadows/', '/fixed_bodies/'
"""
How names begin of what is drawn over everything, of shadows, and of what mjviser calls fixed.

viser has no order for them: the transparent border of a shadow would be a hole in the ground,
which is transparent as well, and a shadow would lie on the lines of a path.
"""

AT_PLOTS, AT_CAMERA, AT_LEGEND = 1e6, 2e6, 3e6
"""Order in the panel of what grows by itself: above a button, it would push it away."""

HOLD_MS = 5000
"""After this time a scene is drawn also where parts of it have not come."""


class Direction(Enum):
    """A button that drives: its sign, its key, its place on the pad, and where it drives to."""

    FORWARD = ('▲', 'ArrowUp', 'up', 1.0, 0.0)
    LEFT = ('◀', 'ArrowLeft', 'left', 0.0, 1.0)
    RIGHT = ('▶', 'ArrowRight', 'right', 0.0, -1.0)
    BACK = ('▼', 'ArrowDown', 'down', -1.0, 0.0)

    def __init__(self, sign: str, key: str, area: str, forward: float, left: float) -> None:
        self.sign = sign
        self.key = key
        self.area = area
        self.forward = forward
        self.left = left


_BAR = 'width:1.4em;height:.35em;border-radius:.2em'
_DOT = 'width:.7em;height:.7em;border-radius:50%'
_STYLE = """
canvas[data-engine] { background: linear-gradient(SKY); }
.husky-pad { display: grid !important; gap: 0.3em; padding: 0 0.6em 0.4em;
  grid-template-areas: ". up ." "left down right"; grid-template-columns: 1fr 1fr 1fr; }
.husky-pad > * { margin: 0 !important; padding: 0 !important; touch-action: none; }
.husky-pad button { height: 2.6em !important; touch-action: none; user-select: none;
  -webkit-user-select: none; }
@media (max-width: 576px) {
  .husky-legend { display: none !important; }
  [style*="width: 20em"]:has(.husky-page) { width: 100% !important; }
  [style*="position: fixed"]:has(.husky-page) { max-height: 52% !important; }
}
button.husky-active, button.husky-active:hover {
  background: var(--mantine-color-blue-filled); color: #fff; }
.husky-stop button, button.husky-stop { height: 3.2em !important; font-size: 1.15em; }
"""

_SCRIPT = """
if (window.huskyPage) return;  // it runs again when a tab has lost its connection
const keys = KEYS, areas = AREAS, presets = PRESETS, places = PLACES;
const style = document.createElement('style');
style.textContent = STYLE;
document.head.append(style);
const buttons = () => [...document.querySelectorAll('button')];
const button = (sign) => buttons().find((b) => b.textContent.trim() === sign);
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
// A box that is ticked has no use for these keys.
const typing = (e) => e.target.closest && e.target.closest(
  'input:not([type=checkbox]), textarea, select, [role=slider], [role=tab], [contenteditable]');
const consume = (e) => { e.preventDefault(); e.stopImmediatePropagation(); };
// Who has chosen from a list, as the robot, drives on by the keys: they would open it again.
let chosen = false;
window.addEventListener('pointerdown', (e) => { if (e.isTrusted) chosen = false; }, true);
window.addEventListener('click', (e) => {
  if (!e.target.closest?.('[role=option]')) return;
  chosen = true;  // the next key may come before the list has let go
  setTimeout(() => document.activeElement?.blur());
}, true);
window.addEventListener('keydown', (e) => {
  if (!(e.key in keys)) chosen = false;
  if (!(e.key in keys) || e.ctrlKey || e.altKey || e.metaKey) return;
  if (typing(e) && !chosen) return;
  if (!button(keys[e.key])) return;
  consume(e);
  if (!held.has(e.key)) { held.add(e.key); send(keys[e.key], 'pointerdown'); }
}, true);
window.addEventListener('keyup', (e) => {
  if (held.has(e.key)) { consume(e); release(e.key); }
}, true);
const releaseAll = () => [...held].forEach(release);
// A finger that lets go beside its button, or whose touch is cancelled, clicks nothing.
window.addEventListener('lostpointercapture', (e) => {
  const sign = e.target.closest && e.target.closest('button')?.textContent.trim();
  if (sign in areas) send(sign, 'click');
}, true);
window.addEventListener('blur', releaseAll);
window.addEventListener('pagehide', releaseAll);
document.addEventListener('visibilitychange', releaseAll);
const makeRoom = () => {
  const canvas = [...document.querySelectorAll('canvas')].find((c) => c.clientWidth > 100);
  const over = window.matchMedia('(max-width: 576px)').matches;
  let panel = over && document.querySelector('.husky-page');
  while (panel && getComputedStyle(panel).position !== 'fixed') panel = panel.parentElement;
  if (!canvas || (over && !panel)) return;
  const height = over ? `${Math.round(panel.getBoundingClientRect().top)}px` : '100%';
  const box = canvas.parentElement.parentElement;
  if (box.style.height !== height) box.style.height = height;
};
let waiting = null;
const play = () => {
  const legend = document.querySelector('[data-plays]');
  if (legend === waiting || !window.__viserMutable?.scene?.visible) return;
  waiting = legend;
  const press = () => { if (legend.isConnected) button(PLAY)?.click(); };
  // The second of two frames begins when the first one is drawn.
  if (legend) requestAnimationFrame(() => requestAnimationFrame(press));
};
// Each tab has a camera of its own: which preset it has is known here alone.
let preset = null;
window.addEventListener('click', (e) => {
  const pressed = e.target.closest && e.target.closest('button');
  if (pressed && presets.includes(pressed.textContent.trim())) preset = pressed;
}, true);
const markActive = () => {
  const page = document.querySelector('.husky-page');
  if (!page) return;
  const camera = preset?.isConnected ? preset.textContent.trim() : presets[0];
  const active = [camera, ...JSON.parse(page.dataset.active || '[]')];
  for (const b of buttons()) {
    const is = active.includes(b.textContent.trim());
    if (is === b.classList.contains('husky-active')) continue;
    b.classList.toggle('husky-active', is);
    b.setAttribute('aria-pressed', is);
  }
};
const order = () => {
  const viewer = window.__viserMutable;
  for (const name in viewer?.nodeRefFromName ?? {}) {
    const [, place] = places.find(([begin]) => name.startsWith(begin)) ?? [];
    if (place === undefined) continue;
    viewer.nodeRefFromName[name]?.traverse((drawn) => {
      if (!drawn.material || drawn.renderOrder === place) return;
      drawn.renderOrder = place;
      if (place > 0) drawn.material.depthTest = false;
      if (place === -1) drawn.material.depthWrite = false;
      viewer.requestRender();
    });
  }
};
// Without a graphics processor each picture of a part takes as long as the one of all.
const drawWhenWhole = () => {
  const viewer = window.__viserMutable, end = performance.now() + HOLD_MS;
  const isThere = ([name, node]) => {
    const type = node?.message?.type ?? 'LabelMessage', made = viewer.nodeRefFromName[name];
    let count = 0;
    made?.traverse((drawn) => { if (drawn.isMesh) count += 1; });
    return type === 'LabelMessage' || (made && (count > 0 || !type.startsWith('Batched')));
  };
  const isWhole = () => document.querySelector('.husky-page') &&
    Object.entries(window.__viserSceneTree.getState()).every(isThere);
  const look = () => {
    if (!isWhole() && performance.now() < end) return requestAnimationFrame(look);
    order();
    viewer.scene.visible = true;
    viewer.requestRender();
  };
  viewer.scene.visible = viewer.backgroundMaterial.visible = false;
  requestAnimationFrame(look);
};
const arrange = () => {
  makeRoom();
  play();
  markActive();
  order();
  for (const sign in areas) {
    const cell = button(sign)?.parentElement;
    if (!cell || cell.style.gridArea) continue;
    cell.style.gridArea = areas[sign];
    cell.parentElement.classList.add('husky-pad');
  }
  const stop = buttons().find((b) => STOPS.includes(b.textContent.trim()));
  if (stop) stop.classList.add('husky-stop');
  // The scene is made for software rendering; the notification would hide a part of it.
  for (const note of document.querySelectorAll('.mantine-Notification-root'))
    if (note.textContent.startsWith('Software WebGL')) note.querySelector('button').click();
};
drawWhenWhole();
arrange();
window.huskyPage = setInterval(arrange, 100);
"""


def add_page_script(server: viser.ViserServer) -> None:
    """Run the scripts of the page in every tab, also in those that open later."""
    script = (
        _SCRIPT.replace('KEYS', json.dumps({d.key: d.sign for d in Direction}))
        .replace('AREAS', json.dumps({d.sign: d.area for d in Direction}))
        .replace('PLAY', json.dumps(PLAY))
        .replace('PRESETS', json.dumps(PRESETS))
        .replace('PLACES', json.dumps([[ON_TOP, 1], [SHADOWS, -1], [FIXED, -2]]))
        .replace('STOPS', json.dumps([STOP, RELEASE]))
        .replace('HOLD_MS', str(HOLD_MS))
        .replace('STYLE', json.dumps(_STYLE))
        .replace('SKY', f'{css(SKY_ABOVE)}, {css(SKY_BELOW)}')
    )
    # viser loads Plotly by this message and has no public method for it. The server keeps the
    # message for new tabs; the elements' HTML cannot do it, for viser runs no scripts in it.
    for source in (script, POINTER_SCRIPT):
        server.gui._websock_interface.queue_message(RunJavascriptMessage(source=source))


def page_html(*, active: Collection[str] = (), plays: bool = False) -> str:
    """
    Return what the script finds the panel by, and what it is to do.

    :param active: labels of the buttons that are marked as what holds now.
    :param plays: whether it is to press Play, as soon as the scene is drawn.
    """
    marks = ' data-plays' if plays else ''
    return f'<div class="husky-page" data-active="{escape(json.dumps([*active]))}"{marks}></div>'


def legend_html(shown: Collection[Rgb]) -> str:
    """
    Return the legend: a word for each colour, with a bar for a line and a dot for points.

    :param shown: the colours of what there is to be seen.
    """
    rows = ''.join(
        '<span style="display:inline-flex;align-items:center;gap:.4em;margin-right:.9em;'
        'vertical-align:top">'
        f'<i style="{_DOT if color in DOTS else _BAR};background:{css(color)};'
        'outline:1px solid #0003"></i>'
        f'{name}</span>'
        for color, name in LEGEND
        if color in shown
    )
    style = 'padding:0 1em .6em;font-size:.8em;line-height:1.5'
    return f'<div class="husky-legend" style="{style}">{rows}</div>'


def show_html(element: viser.GuiHtmlHandle, html: str) -> None:
    """Show something else, if it is something else."""
    if html != element.content:
        element.content = html


def in_decimals(value: float, decimals: int, *, sign: str = '') -> str:
    """Return a number in so many decimals, 0.00 and never -0.00; sign '+' shows that, too."""
    return f'{round(value, decimals) + 0.0:{sign}.{decimals}f}'


def figures_html(cells: Sequence[tuple[str, str, str]], *, red: str = '') -> str:
    """
    Return figures as a small table.

    :param cells: label, value and key of each.
    :param red: key of the one that is drawn in red.
    """
    rows = ''.join(
        '<div style="min-width:5.6em"><div style="opacity:.65;font-size:.78em">'
        f'{label}</div><b data-number="{key}" style="font-variant-numeric:tabular-nums'
        f'{";color:#e33" if key == red else ""}">{value}</b></div>'
        for label, value, key in cells
    )
    return (
        '<div style="display:grid;grid-template-columns:1fr 1fr 1fr;gap:.35em .6em;'
        f'padding:.2em 1em .6em">{rows}</div>'
    )
