# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
How soon the first tab shows something after the view has printed its address.

Prints, in seconds, when the first figures and the whole scene are seen, and the pictures a second
that follow. Browser and view are new in each round; the browser is open when the address comes, as
that of a person is. It is a real one, in which a processor draws.

Run it with:  ./lab exec python benchmark/first_tab.py
"""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import statistics
import sys
import time

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from husky_runtime.domains import in_own_domain
import numpy as np
from playpen_testing import chromium
from playpen_testing.browser import start_browser
from playpen_testing.processes import Process, Processes
from playwright.sync_api import Page, ViewportSize

PORT = 18881
SIZE = ViewportSize(width=1200, height=750)
SEEN_SEC = 7.0
"""How long a tab is looked at."""

SAME, MOST_OTHER = 30, 0.01
"""The scene is whole when so few of its pixels are more than this off what they stay."""

# After each frame that draws, the canvas is read, small: it has what the frame has drawn.
PROBE = """(() => {
  const WIDTH = 60, HEIGHT = 38, BESIDE_PANEL = 43;
  const now = () => (performance.timeOrigin + performance.now()) / 1000;
  const seen = window.seen = {figures: 0, pictures: []};
  let canvas = null;
  for (const name of ['drawElements', 'drawElementsInstanced']) {
    const draw = WebGL2RenderingContext.prototype[name];
    WebGL2RenderingContext.prototype[name] = function (...given) {
      canvas = this.canvas;
      return draw.apply(this, given);
    };
  }
  const pen = Object.assign(document.createElement('canvas'), {width: WIDTH, height: HEIGHT})
    .getContext('2d', {willReadFrequently: true});
  const soon = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => soon((time) => {
    draw(time);
    if (!canvas || canvas.width < 400) return;
    pen.clearRect(0, 0, WIDTH, HEIGHT);
    pen.drawImage(canvas, 0, 0, WIDTH, HEIGHT);
    canvas = null;
    seen.pictures.push([now(), ...pen.getImageData(0, 0, BESIDE_PANEL, HEIGHT).data]);
  });
  const watch = setInterval(() => {
    const figure = document.querySelector('[data-number=time]');
    if (!figure?.textContent || !document.getElementById('husky-waiting').hidden) return;
    clearInterval(watch);
    soon(() => { seen.figures = now(); });
  }, 20);
})()"""


@contextmanager
def simulator() -> Iterator[Processes]:
    """Run a simulator, and whatever else is started meanwhile."""
    with Processes() as processes:
        processes.start('ros2', 'run', 'husky_sim', 'husky_sim').wait_for_text('obstacles')
        yield processes


def address_of(view: Process) -> str:
    view.wait_for_text('look at http://')
    return view.output.split('look at ')[1].split()[0]


def figures_of(page: Page, begun_sec: float) -> dict[str, float]:
    """Return what there is to tell of a page that was opened at a time (Unix)."""
    seen = page.evaluate('seen')
    pictures = np.array(seen['pictures'])
    times, pixels = pictures[:, 0] - begun_sec, pictures[:, 1:]
    others = (np.abs(pixels - pixels[-1]) > SAME).mean(axis=1)
    whole = int(np.flatnonzero(np.append(True, others > MOST_OTHER))[-1])
    return {
        'first figures, s': seen['figures'] - begun_sec,
        'whole scene, s': float(times[whole]),
        'pictures a second after it': (len(times) - 1 - whole) / float(times[-1] - times[whole]),
    }


def look(processes: Processes, program: chromium.Program) -> dict[str, float]:
    """Start a view, and look at it."""
    with start_browser(program) as browser:
        page = browser.new_page(viewport=SIZE)
        page.add_init_script(PROBE)
        page.goto('about:blank')
        view = processes.start(
            'ros2', 'run', 'husky_view', 'view', '--ros-args', '-p', f'viewer_port:={PORT}'
        )
        address = address_of(view)
        begun_sec = time.time()
        page.goto(address, wait_until='commit')
        page.wait_for_timeout(SEEN_SEC * 1000.0)
        figures = figures_of(page, begun_sec)
        view.close()
        return figures


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--rounds', type=int, default=5)
    options = parser.parse_args()
    program = chromium.find_or_install()
    with simulator() as processes:
        rounds = [look(processes, program) for _ in range(options.rounds)]
    for name in rounds[0]:
        values = [each[name] for each in rounds]
        listed = ' '.join(f'{value:.2f}' for value in values)
        print(f'{name:28} median {statistics.median(values):6.2f}   ({listed})')
    print(f'load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors', file=sys.stderr)


if __name__ == '__main__':
    with in_own_domain():
        main()
