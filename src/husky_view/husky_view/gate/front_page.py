# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The page that a browser loads: viser's, under our title, with words for the time of waiting."""

from html import escape
import json
from pathlib import Path

import viser

LOADING = 'Loading the scene ...'
LATE = (
    'Nothing comes. Does the program that served this page still run? Its terminal says more. If '
    'very many tabs look at this page, it goes on when one of them is closed.'
)
NO_WEBGL = (
    'This browser draws nothing in 3D here: it has no WebGL. Firefox has it on most desktops, '
    'also without a graphics processor; Chrome and Chromium need one, or '
    'chrome://flags/#ignore-gpu-blocklist set to Enabled.'
)
LOST = (
    'This has ended, or the network is gone. What comes back, or a replay that follows, opens '
    'here by itself; a new start has an address of its own.'
)
SILENT = (
    'No answer: nothing that is pressed here arrives, STOP neither. What serves this page stands '
    'still, or the network swallows all; this page goes on by itself when they do.'
)
ALIVE = 'alive'
"""What a page asks for below its own address, to hear whether it is answered."""

# viser looks for a lost server only while somebody types into the page, and writes the address of
# its websocket behind ours. Until the scene comes it takes its light from a picture that is in the
# page; where a processor draws, to load that takes half a second, and ours has other lights.
# It gives a connection up after a second and tries the next one. Browsers let one wait for up to
# 5 s where many have failed, so that none would ever come through.
_BEFORE = """
document.hasFocus = () => true;
history.replaceState = () => {};
const fetchAny = window.fetch;
window.fetch = (what, ...more) => {
  const isLight = (what.url ?? String(what)).startsWith('data:image/jpeg');
  return isLight ? new Promise(() => {}) : fetchAny(what, ...more);
};
const postAny = Worker.prototype.postMessage;
let tries = 0, asked = -Infinity, tried = -Infinity;
Worker.prototype.postMessage = function (message, ...more) {
  if (message?.type === 'retry') {
    const now = performance.now();
    if (now - asked > 3000) tries = 0;  // it was connected
    asked = now;
    if (tries >= 10 && now - tried < 6000) return;
    tries += 1;
    tried = now;
  }
  postAny.call(this, message, ...more);
};
"""

_STYLE = """
#husky-waiting { position: fixed; z-index: 10000; inset: 0; display: flex; flex-direction: column;
  align-items: center; justify-content: center; gap: .6em; padding: 1em; text-align: center;
  background: #eef3fa; color: #234; font: 1em/1.4 system-ui, sans-serif; }
#husky-waiting.lost { inset: 0 0 auto 0; background: #c40; color: #fff; }
#husky-waiting.lost b { display: none; }
#husky-waiting[hidden] { display: none; }
"""

_SCRIPT = """
const cover = document.getElementById('husky-waiting'), words = cover.lastElementChild;
const told = TOLD;
let since = performance.now(), connected = false, unanswered = 0, draws;
const canDraw = () => {
  const drawing = document.createElement('canvas').getContext('webgl2');
  drawing?.getExtension('WEBGL_lose_context')?.loseContext();
  return drawing !== null;
};
const say = (text, lost) => {
  cover.classList.toggle('lost', lost);
  cover.hidden = !text;
  if (text && words.textContent !== text) words.textContent = text;
};
// Where the other side stands still or nothing comes through, no connection is closed for minutes.
// A new one that is refused tells nothing: where too many are open, that of the page goes on.
const alive = `${location.pathname.replace(/[/]+$/, '')}/${told.alive}`;
const ask = async () => {
  const options = {cache: 'no-store', signal: AbortSignal.timeout(2000)};
  const isRefused = (e) => e.name !== 'TimeoutError' && navigator.onLine;
  const answered = !connected || await fetch(alive, options).then((a) => a.ok, isRefused);
  unanswered = answered ? 0 : unanswered + 1;
  setTimeout(ask, 1000);
};
ask();
setInterval(() => {
  const panel = document.querySelector('.husky-page, [data-trouble]');
  connected = panel && getComputedStyle(panel).pointerEvents !== 'none';
  const now = performance.now();
  if (connected) since = now;
  const waits = now - since;
  if (connected && unanswered > 1) say(told.silent, true);
  else if (connected || (panel && waits < 1500)) say('', false);
  else if (panel) say(told.lost, true);
  else if (waits < 2000) say(told.loading, false);
  else if (!(draws ??= canDraw())) say(told.noWebgl, false);
  else say(waits < 10000 ? told.loading : told.late, false);
}, 100);
"""


def front_page(title: str) -> bytes:
    """
    Return viser's page, which is one file, with ours around it.

    Until the panel has come, it covers everything with words; viser dims a panel whose server is
    gone, by which that is found out.
    """
    file = Path(viser.__file__).parent / 'client' / 'build' / 'index.html'
    told = {'loading': LOADING, 'noWebgl': NO_WEBGL, 'late': LATE, 'lost': LOST, 'silent': SILENT}
    words = json.dumps({**told, 'alive': ALIVE})
    cover = (
        f'<div id="husky-waiting"><b>{escape(title)}</b><span>{LOADING}</span></div>'
        f'<script>(() => {{{_SCRIPT.replace("TOLD", words)}}})();</script>'
    )
    head = f'<title>{escape(title)}</title><style>{_STYLE}</style><script>{_BEFORE}</script>'
    page = file.read_text(encoding='utf-8')
    page = page.replace('<title>Viser</title>', head, 1).replace('<body>', f'<body>{cover}', 1)
    return page.encode()
