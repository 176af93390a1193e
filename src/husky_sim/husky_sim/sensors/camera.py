# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The camera on the top plate, drawn off the screen with EGL or OSMesa.

All calls of OpenGL must come from the thread that draws first.
"""

from functools import partial
import math
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from husky_sim.errors import SettingError
from husky_sim.sensors.poses import follow

WIDTH, HEIGHT = 640, 480
FRAME = 'camera'
_SEEN_GROUPS = (0, 1, 2)  # group 3 holds the collision shapes of the robots


class Camera:
    """Draws the view from one robot."""

    def __init__(
        self,
        name: str,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        *,
        setting: str = 'camera_rate_hz',
        off: str = '0',
    ) -> None:
        """
        Make sure that drawing is possible.

        :param setting: what asks for pictures, and with which value it does not.
        :raises SettingError: if there is neither EGL nor OSMesa.
        """
        self._model, self._moved = model, data
        self._data = mujoco.MjData(model)
        self._view = mujoco.MjvCamera()
        self._view.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self._view.fixedcamid = model.camera(f'{name}/camera').id
        self._viewport = mujoco.MjrRect(0, 0, WIDTH, HEIGHT)
        self._pixels = np.zeros((HEIGHT, WIDTH, 3), dtype=np.uint8)
        self._drawing: tuple[Any, ...] | None = None
        self._new_context = partial(_new_context, setting, off)
        self._new_context().free()

    @property
    def focal_length_px(self) -> float:
        """Return the focal length, for camera_info."""
        half = math.radians(float(self._model.cam_fovy[self._view.fixedcamid])) / 2.0
        return HEIGHT / 2.0 / math.tan(half)

    def picture(self) -> npt.NDArray[np.uint8]:
        """Draw, and return rows from the top of red, green and blue."""
        if self._drawing is None:
            self._drawing = self._begin()
        context, scene, options, renderer = self._drawing
        follow(self._moved, self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_camlight(self._model, self._data)
        context.make_current()
        mujoco.mjv_updateScene(
            self._model,
            self._data,
            options,
            None,
            self._view,
            mujoco.mjtCatBit.mjCAT_ALL,
            scene,
        )
        mujoco.mjr_render(self._viewport, scene, renderer)
        mujoco.mjr_readPixels(self._pixels, None, self._viewport, renderer)
        return self._pixels[::-1]

    def _begin(self) -> tuple[Any, ...]:
        context = self._new_context()
        context.make_current()
        scene = mujoco.MjvScene(self._model, maxgeom=5000)
        visual = self._model.vis.global_  # a world may ask for less, and the rest would be black
        visual.offwidth = max(visual.offwidth, WIDTH)
        visual.offheight = max(visual.offheight, HEIGHT)
        options = mujoco.MjvOption()
        options.geomgroup[:] = [group in _SEEN_GROUPS for group in range(6)]
        renderer = mujoco.MjrContext(self._model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, renderer)
        return context, scene, options, renderer

    def close(self) -> None:
        """Release the drawing surface; may be called twice."""
        if self._drawing is not None:
            self._drawing[3].free()
            self._drawing[0].free()
            self._drawing = None


def _new_context(setting: str, off: str) -> Any:
    problems = []
    for platform in ('mujoco.egl', 'mujoco.osmesa'):
        try:  # to import one of these loads its library, and fails where there is none
            if platform == 'mujoco.egl':
                from mujoco.egl import GLContext
            else:
                from mujoco.osmesa import GLContext
            return GLContext(WIDTH, HEIGHT)
        except Exception as error:  # drivers, or their absence, raise many types
            problems.append(f'{platform}: {" ".join(str(error).split())}')
    raise SettingError(
        f'{setting}: no picture can be drawn here ({"; ".join(problems)}); install EGL '
        f'(libegl1 and libgl1-mesa-dri) or set {setting} to {off}'
    )
