# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tell scenes that can be from nonsense, which is not drawn."""

from husky_sim.scene_topic import Scene, TRACK
from husky_sim.world import World
import mujoco
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

FARTHEST_M = 1e6
LENGTH_ERROR = 0.1  # of a quaternion
JUMP_M, JUMP_M_S = 0.25, 2.0  # further than this, and this times the time between, is a jump

_PLACES = [TRACK.index(name) for name in ('x', 'y', 'odom_x', 'odom_y')]
_X, _Y = slice(0, None, 2), slice(1, None, 2)


class SceneCheck:
    """Looks at every scene of one world, in the order in which they come."""

    def __init__(self, world: World) -> None:
        model = world.model
        self._size = int(model.nq)
        free = model.jnt_type == mujoco.mjtJoint.mjJNT_FREE
        self._turns = model.jnt_qposadr[free][:, None] + np.arange(3, 7)
        self._last: tuple[float, Array] | None = None

    def complaint(self, scene: Scene) -> str:
        """
        Return why a scene cannot be true, or nothing.

        A jump is believed with the scene after it, if that goes on from there: somebody may have
        put the robot elsewhere.
        """
        if scene.qpos.shape != (self._size,):
            return f'{len(scene.qpos)} joint positions instead of {self._size}'
        for name, values in (('joint', scene.qpos), ('track', scene.track)):
            if not np.isfinite(values).all():
                return f'a {name} position is no number'
        if not np.isfinite(scene.time_sec).all():
            return 'the time is no number'
        places = scene.track[:, :, _PLACES]
        if np.abs(places).max() > FARTHEST_M:
            return f'a robot is {np.abs(places).max():.6g} m away'
        lengths = np.linalg.norm(scene.qpos[self._turns], axis=1)
        if len(lengths) and np.abs(lengths - 1.0).max() > LENGTH_ERROR:
            return 'an orientation is no rotation: its length is not 1'
        return self._jump(scene.time_sec, places)

    def _jump(self, time_sec: Array, places: Array) -> str:
        if self._last is not None:
            time_sec = np.concatenate([[self._last[0]], time_sec])
            places = np.concatenate([self._last[1][None], places])
        self._last = float(time_sec[-1]), places[-1].copy()
        periods = np.diff(time_sec)
        step = np.diff(places, axis=0)
        away = np.hypot(step[:, :, _X], step[:, :, _Y]).max(axis=(1, 2))
        # Where the time goes back, a new run has begun.
        jumps = (periods >= 0.0) & (away > JUMP_M + JUMP_M_S * periods)
        if not jumps.any():
            return ''
        first = int(np.argmax(jumps))
        return f'a robot jumps {away[first]:.2f} m in {periods[first]:.3f} s'
