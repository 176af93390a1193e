# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Make the pictures of docs/: the robot, the playpen, the view's pages and two reports.

Run it with:  ./lab exec python docs/pictures.py
It needs EGL, and what ./lab test installs. docs/animation.py makes the animated one.
"""

import os
from pathlib import Path
import subprocess
import sys
from tempfile import TemporaryDirectory

os.environ.setdefault('MUJOCO_GL', 'egl')  # read when mujoco is imported
os.environ['PLAYPEN_PICTURES'] = 'docs'  # where the view's tests keep theirs
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from husky_course.robot import RobotStart
from husky_grader.file_grading import grade_file
from husky_sim.world import default_worlds, load_world
import mujoco
import numpy as np
from PIL import Image
from playpen_testing import chromium
from playpen_testing.browser import keep_still, start_browser
from playpen_testing.processes import Processes
from playwright.sync_api import Browser

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / 'docs'
PASSING = ROOT / 'config' / 'waypoints' / 'central_barrier.yaml'
FAILING = 'waypoints:\n  - [0, 0]\n  - [-3, 2]\n  - [0, 4]\n  - [4.2, -3.2]\n'
WIDTH, HEIGHT = 960, 540
REPORT, WAITING = (900, 1150), (900, 300)


class Studio:
    """A camera that flies round a world."""

    def __init__(self, world: str, start: RobotStart, *, lamp: float = 0.0) -> None:
        """Load the world; the camera may carry a lamp that fills its shadows."""
        self._model = load_world(str(default_worlds() / world), [start]).model
        self._data = mujoco.MjData(self._model)
        mujoco.mj_forward(self._model, self._data)
        self._model.vis.headlight.diffuse[:] = lamp
        self._model.vis.quality.shadowsize = 8192
        self._model.vis.global_.offwidth = 2 * WIDTH
        self._model.vis.global_.offheight = 2 * HEIGHT
        self._renderer = mujoco.Renderer(self._model, 2 * HEIGHT, 2 * WIDTH)

    def picture(
        self, azimuth_deg: float, *, at: tuple[float, float, float], distance_m: float, tilt: float
    ) -> np.ndarray:
        """Draw at twice the size, so that shrinking smooths the edges."""
        camera = mujoco.MjvCamera()
        camera.lookat[:] = at
        camera.distance, camera.elevation, camera.azimuth = distance_m, tilt, azimuth_deg
        self._renderer.update_scene(self._data, camera)
        return np.asarray(self._renderer.render().copy())


def save(pixels: np.ndarray, name: str) -> None:
    """Write a small JPEG."""
    picture = Image.fromarray(pixels).resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)
    picture.save(FOLDER / name, quality=82, optimize=True)


def draw_models() -> None:
    """Draw the robot from four sides, and the playpen."""
    studio = Studio('empty.xml', RobotStart(), lamp=0.4)
    sides = [
        studio.picture(azimuth, at=(0.0, 0.0, 0.15), distance_m=1.35, tilt=tilt)
        for azimuth, tilt in ((180.0, -12.0), (270.0, -12.0), (0.0, -12.0), (140.0, -24.0))
    ]
    save(np.vstack([np.hstack(sides[:2]), np.hstack(sides[2:])]), 'husky.jpg')
    studio = Studio('playpen.xml', RobotStart())
    save(studio.picture(120.0, at=(0.0, -0.2, 0.0), distance_m=19.0, tilt=-47.0), 'playpen.jpg')


def keep_page(browser: Browser, url: str, size: tuple[int, int], name: str) -> None:
    """Keep a picture of a page that nothing is sent to after it has come."""
    page = browser.new_page(viewport={'width': size[0], 'height': size[1]})
    page.route_web_socket('**', lambda _: None)  # connected, and silent
    page.goto(url)
    keep_still(page, FOLDER / name)
    page.close()
    Image.open(FOLDER / name).convert('RGB').quantize(256).save(FOLDER / name, optimize=True)


def keep_reports(browser: Browser, scratch: Path) -> None:
    """Grade a file that passes and one that hits a barrier, and show the page on each."""
    through = scratch / 'through_the_barrier.yaml'
    through.write_text(FAILING)
    for course, name in ((PASSING, 'report_pass'), (through, 'report_fail')):
        grade_file(str(course), scratch / name)
        keep_page(browser, f'file://{scratch / name}/report.html', REPORT, f'{name}.png')


def keep_waiting(browser: Browser, scratch: Path) -> None:
    """Show what the page says until the scene comes."""
    with Processes() as processes:
        process = processes.start('ros2', 'run', 'husky_view', 'replay', str(scratch))
        process.wait_for_text('look at http://')
        address = process.output.split('look at ')[1].split()[0]
        keep_page(browser, address, WAITING, 'view_loading.png')


def main() -> None:
    """Make all of them; those of the view are kept by the tests that look at them."""
    draw_models()
    subprocess.run([ROOT / 'lab', 'test', 'test/test_view_pictures.py'], cwd=ROOT, check=True)
    with (
        TemporaryDirectory() as name,
        start_browser(chromium.find_or_install()) as browser,
    ):
        keep_reports(browser, Path(name))
        keep_waiting(browser, Path(name) / 'report_fail')


if __name__ == '__main__':
    main()
