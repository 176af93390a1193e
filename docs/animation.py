# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Make docs/playpen.gif: the replay of a real run in a real browser, time by time.

Run it with:  ./lab exec python docs/animation.py
"""

from collections.abc import Iterator
from contextlib import contextmanager
import io
import os
from pathlib import Path
import sys
from tempfile import TemporaryDirectory
from typing import Literal

os.environ['PLAYPEN_PICTURES'] = 'docs'  # smooth edges; read when the browser's module is imported
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from husky_grader.file_grading import grade_file
import numpy as np
from PIL import Image
from playpen_testing import chromium
from playpen_testing.browser import button, number, open_page, screenshot, start_browser
from playpen_testing.processes import Processes
from playpen_testing.waiting import wait_until
from playwright.sync_api import Page

ROOT = Path(__file__).resolve().parents[1]
COURSE = ROOT / 'config' / 'waypoints' / 'central_barrier.yaml'
FILE = ROOT / 'docs' / 'playpen.gif'
PAGE = 1000, 560
WIDTH, HEIGHT = 800, 448
SECONDS, PICTURES_A_SECOND = 10, 10
LAST_SEC = 1.5  # the last picture stays


@contextmanager
def replay(folder: Path) -> Iterator[Page]:
    """Drive the course, and show the run on a page."""
    grade_file(str(COURSE), folder)
    with Processes() as processes, start_browser(chromium.find_or_install()) as browser:
        process = processes.start('ros2', 'run', 'husky_view', 'replay', str(folder))
        process.wait_for_text('look at http://')
        address = process.output.split('look at ')[1].split()[0]
        yield open_page(browser, address, *PAGE, drawn=True)


def go_near(page: Page) -> None:
    """Move the camera so that the course fills what the panel leaves free."""
    drags: list[tuple[Literal['left', 'right'], int, int]] = [('right', -190, 60), ('left', 0, 30)]
    for held, by_x, by_y in drags:
        page.mouse.move(500, 300)
        page.mouse.down(button=held)
        page.mouse.move(500 + by_x, 300 + by_y, steps=4)
        page.mouse.up(button=held)
    for _ in range(5):
        page.mouse.wheel(0.0, -240.0)
    page.mouse.move(830, 400)  # over the panel, no coordinates are shown


def picture_at(page: Page, time_sec: float) -> Image.Image:
    """Show a time of the run, and return the page when nothing moves any more."""
    field = page.locator('input[inputmode=decimal]')
    field.fill(f'{time_sec:.1f}')
    field.press('Enter')
    field.blur()  # no cursor that blinks
    wait_until(
        lambda: number(page, 'time').inner_text() == f'{time_sec:.1f} s',
        timeout_sec=30.0,
        what=f'the time {time_sec:.1f} s',
    )
    pictures = [screenshot(page)]

    def is_still() -> bool:
        pictures.append(screenshot(page))
        return pictures[-3:] == 3 * pictures[-1:]

    wait_until(is_still, timeout_sec=60.0, what='a page on which nothing moves')
    picture = Image.open(io.BytesIO(pictures[-1])).convert('RGB')
    return picture.resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)


def save(pictures: list[Image.Image]) -> None:
    """Write them with one palette: what does not move then costs nothing."""
    several = Image.fromarray(np.vstack([np.asarray(each) for each in pictures[::8]]))
    # By coverage, or the few pixels of a trail would take on the colour of something else; then
    # each colour goes to the middle of those that it stands for, or asphalt would be brown.
    palette = several.quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=1)
    first, *others = (
        each.quantize(palette=palette, dither=Image.Dither.NONE) for each in pictures
    )
    tick_ms = 1000 // PICTURES_A_SECOND
    durations = [tick_ms] * len(others) + [round(1000 * LAST_SEC)]
    first.save(FILE, save_all=True, append_images=others, duration=durations, loop=0)


def main() -> None:
    """Make the picture."""
    with TemporaryDirectory() as name, replay(Path(name)) as page:
        button(page, 'Pause').click()
        go_near(page)
        end_sec = float(number(page, 'duration').inner_text().split()[0])
        times = np.linspace(0.0, end_sec, SECONDS * PICTURES_A_SECOND)
        save([picture_at(page, time_sec) for time_sec in times])


if __name__ == '__main__':
    main()
