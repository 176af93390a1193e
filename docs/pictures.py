# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Draw docs/husky.jpg, from four sides, and docs/playpen.jpg; needs EGL.

Run it with:  ./lab exec python docs/pictures.py
"""

import os
from pathlib import Path

os.environ.setdefault('MUJOCO_GL', 'egl')  # read when mujoco is imported

from husky_course.robot import RobotStart
from husky_sim.world import default_worlds, load_world
import mujoco
import numpy as np
from PIL import Image

FOLDER = Path(__file__).resolve().parent
WIDTH, HEIGHT = 960, 540


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


def main() -> None:
    """Draw both pictures."""
    studio = Studio('empty.xml', RobotStart(), lamp=0.4)
    sides = [
        studio.picture(azimuth, at=(0.0, 0.0, 0.15), distance_m=1.35, tilt=tilt)
        for azimuth, tilt in ((180.0, -12.0), (270.0, -12.0), (0.0, -12.0), (140.0, -24.0))
    ]
    save(np.vstack([np.hstack(sides[:2]), np.hstack(sides[2:])]), 'husky.jpg')
    studio = Studio('playpen.xml', RobotStart())
    save(studio.picture(120.0, at=(0.0, -0.2, 0.0), distance_m=19.0, tilt=-47.0), 'playpen.jpg')


if __name__ == '__main__':
    main()
