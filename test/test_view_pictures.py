# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What is drawn, looked at pixel by pixel.

PLAYPEN_PICTURES=docs keeps the pictures there.
"""

from collections.abc import Iterator
from pathlib import Path
import shutil
from typing import Protocol

from husky_course.record import COURSE_NAME
from husky_sim.recording import RunRecorder
from husky_sim.simulation import Simulation
from husky_sim.world import default_worlds
from husky_view.picture import palette
from matplotlib.colors import rgb_to_hsv
import numpy as np
from PIL import Image
from playpen_testing.browser import (
    asphalt,
    button,
    errors,
    keep_still,
    KEPT,
    number,
    open_page,
    pixels_of,
    screenshot,
)
from playpen_testing.processes import Processes
from playpen_testing.view_lab import Lab, view_lab
from playpen_testing.waiting import wait_until
from playwright.sync_api import Browser, expect, Page
import pytest

from husky_sim.config import SimulationConfig

ROOT = Path(__file__).resolve().parent.parent
COURSE = ROOT / 'config' / 'waypoints' / 'central_barrier.yaml'
ORDER = """['/fixed_bodies/', '/shadows/husky'].map((begin) => {
  const nodes = window.__viserMutable.nodeRefFromName, orders = new Set();
  for (const name in nodes) if (name.startsWith(begin))
    nodes[name]?.traverse((drawn) => { if (drawn.material) orders.add(drawn.renderOrder); });
  return [...orders].join();
}).map(Number)"""
DESK, PHONE = (1200, 750) if KEPT else (900, 560), (390, 844)


class Keep(Protocol):
    def __call__(self, page: Page, name: str, *, still: bool = True) -> None: ...


@pytest.fixture(scope='module')
def keep() -> Iterator[Keep]:
    """Keep a picture of a page, if any are to be kept; `still`: when nothing moves any more."""
    folder = ROOT / (KEPT or '')
    kept = list[Path]()

    def keep_picture(page: Page, name: str, *, still: bool = True) -> None:
        if KEPT:
            kept.append(folder / name)
            if still:
                keep_still(page, folder / name)
            else:
                (folder / name).write_bytes(screenshot(page))

    yield keep_picture
    for file in kept:
        # By coverage, or the few pixels of a trail would take on the colour of something else;
        # dithered, or the sky would come in steps.
        whole = Image.open(file).convert('RGB')
        palette_of = whole.quantize(256, Image.Quantize.MAXCOVERAGE)
        whole.quantize(palette=palette_of).save(file, optimize=True)


@pytest.fixture(scope='module')
def lab(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    with view_lab(tmp_path_factory.mktemp('pictures_lab'), browser) as started:
        shutil.copy(COURSE, started.folder)
        yield started


def count(png: bytes, color: palette.Rgb) -> int:
    """Return how many pixels of the scene have about this hue; light makes colours paler."""
    hsv = rgb_to_hsv(pixels_of(png)[:, : DESK[0] - 340] / 255.0)
    hue = rgb_to_hsv(np.array(color) / 255.0)[0]
    away = np.abs((hsv[..., 0] - hue + 0.5) % 1.0 - 0.5)
    return int(((away < 0.04) & (hsv[..., 1] > 0.3)).sum())


def red(png: bytes) -> int:
    """Return how many pixels are of the pure red that only a collision has."""
    scene = pixels_of(png)[:, : DESK[0] - 340]
    return int((np.abs(scene - (220, 0, 0)).max(axis=2) < 45).sum())


@pytest.mark.timeout(180)
def test_a_drive_shows_path_and_trail_in_the_legends_colours(lab: Lab, keep: Keep) -> None:
    page = lab.open(*DESK, drawn=True)
    button(page, 'Follow').dispatch_event('click')
    driver = lab.drive(COURSE)
    wait_until(
        lambda: lab.truth.pose.pose.position.x > 3.2,
        timeout_sec=60.0,
        what=lambda: f'a robot at the end of the barrier\n{driver.output}',
    )
    keep(page, 'view_live.png', still=False)
    lab.pause()
    button(page, 'Resume').wait_for()
    shown = {'path': palette.PATH, 'true trail': palette.TRUE_TRAIL}

    def missing() -> list[str]:
        png = screenshot(page)
        return [what for what, color in shown.items() if count(png, color) < 25]

    wait_until(lambda: not missing(), timeout_sec=60.0, what=lambda: f'{missing()} in the picture')
    legend = page.locator('.husky-legend')
    expect(legend).to_contain_text('given path and waypoints')
    expect(legend).not_to_contain_text('lidar')
    assert errors(page) == []
    assert page.evaluate(ORDER) == [-2, -1], 'shadows would be holes in the ground'
    assert int(number(page, 'left').inner_text()) < 13
    assert abs(float(number(page, 'cross').inner_text().split()[0])) < 0.3
    page.close()
    driver.close()


@pytest.mark.timeout(180)
def test_the_editor_shows_where_a_course_passes_too_near(lab: Lab, keep: Keep) -> None:
    lab.pause()
    through = lab.folder / 'through.yaml'
    through.write_text('waypoints:\n  - [0, 0]\n  - [-3, 2]\n  - [0, 4]\n  - [4.2, -3.2]\n')
    page = lab.open(*DESK, drawn=True)
    button(page, 'Top').dispatch_event('click')
    page.get_by_text('Waypoints', exact=True).dispatch_event('click')
    page.get_by_label('Open', exact=True).click()
    png = screenshot(page)
    before = {
        'enough room': count(png, palette.CLEAR),
        'no room': count(png, palette.BLOCKED),  # hydrants are red as well
    }
    page.get_by_role('option', name='through', exact=True).click()
    page.locator('[data-verdict]').wait_for()
    colors = {'enough room': palette.CLEAR, 'no room': palette.BLOCKED}

    def missing() -> list[str]:
        png = screenshot(page)
        return [what for what, color in colors.items() if count(png, color) < before[what] + 60]

    wait_until(lambda: not missing(), timeout_sec=60.0, what=lambda: f'{missing()} in the picture')
    button(page, 'Save and drive it').evaluate('each => each.scrollIntoView({block: "end"})')
    keep(page, 'view_editor.png')
    page.close()


@pytest.mark.timeout(180)
def test_a_phone_shows_the_playpen_above_the_controls(lab: Lab, keep: Keep) -> None:
    lab.pause()  # `still` is only what stands
    page = lab.open(*PHONE, drawn=True)

    def is_seen() -> bool:
        button(page, 'Top').dispatch_event('click')
        return asphalt(screenshot(page)) > 40000

    wait_until(is_seen, timeout_sec=60.0, what='asphalt above the panel')
    keep(page, 'view_phone.png')
    page.close()


@pytest.mark.timeout(180)
def test_a_replay_shows_the_collision_in_red(
    browser: Browser, tmp_path: Path, keep: Keep, processes: Processes
) -> None:
    simulation = Simulation(SimulationConfig(world=str(default_worlds() / 'playpen.xml')))
    record = RunRecorder(simulation, tmp_path / 'run.record')
    for step in range(400):
        turn = 0.25 if step > 40 else 0.0
        simulation.robots[0].controller.command(0.6, turn, time_sec=simulation.time_sec)
        simulation.advance()
        record.append()
    record.close()
    shutil.copy(COURSE, tmp_path / COURSE_NAME)
    replay = processes.start('ros2', 'run', 'husky_view', 'replay', str(tmp_path))
    replay.wait_for_text('look at http://')
    address = replay.output.split('look at ')[1].split()[0]
    page = open_page(browser, address, *DESK, drawn=True)
    page.get_by_role('button', name='jersey_barrier_15').click()
    wait_until(
        lambda: red(screenshot(page)) > 30,
        timeout_sec=60.0,
        what='the red mark of a collision',
    )
    keep(page, 'view_replay.png')
    page.close()
