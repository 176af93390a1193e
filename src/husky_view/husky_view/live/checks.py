# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of the scenes that come in: from which simulator, whether valid, how fast time passes."""

from collections import deque
from enum import auto, Enum
import math

from husky_course.frames import Array
from husky_runtime.settings import settings_of
from husky_sim.scene_topic import Scene, TRACK
from husky_sim.world import World
import mujoco
import numpy as np

from husky_sim.config import DriveConfig

SILENCE_SEC = 1.5
"""A simulator that was silent for so long is gone; it publishes at 30 Hz, paused or not."""

DISCOVERY_SEC = 3.0
"""How much longer the first scene may take."""

FARTHEST_M = 1e6
LENGTH_ERROR = 0.1  # of a quaternion
_SPEED_LIMIT = next(each for each in settings_of(DriveConfig) if each.name == 'speed_limit_m_s')
JUMP_M, JUMP_M_S = 0.25, 2.0 * _SPEED_LIMIT.high
"""Further than this, and this times the time between, is a jump."""

WINDOW_SEC = 1.0

_PLACES = [TRACK.index(name) for name in ('x', 'y', 'odom_x', 'odom_y')]
_X, _Y = slice(0, None, 2), slice(1, None, 2)


class State(Enum):
    """Whether the simulation that is shown runs."""

    HERE = auto()
    GONE = auto()
    ANOTHER_WORLD = auto()
    TWO = auto()


class SimulatorMonitor:
    """
    Tells from the origin of scenes which simulators run. Times are of a steady wall clock.

    :param world: the key of the world that is shown.
    """

    def __init__(self, world: str, *, now_sec: float) -> None:
        self.world = world
        self._run = ''  # of the simulator that is shown, once a scene has come
        self._last_sec = now_sec + DISCOVERY_SEC
        self._second_sec = -math.inf
        self._other_world_sec = -math.inf

    def accept(self, world: str, run: str, *, now_sec: float) -> bool:
        """Register a scene; returns whether it is to be shown."""
        if world != self.world:
            self._other_world_sec = now_sec
            return False
        if run == self._run or not self._run or now_sec - self._last_sec > SILENCE_SEC:
            self._run, self._last_sec = run, now_sec
            return True
        self._second_sec = now_sec
        return False

    def state(self, *, now_sec: float) -> State:
        """Return which simulators run now."""
        silent_sec = now_sec - self._last_sec
        another = now_sec - self._other_world_sec <= SILENCE_SEC
        if silent_sec <= SILENCE_SEC and self._run:
            two = another or now_sec - self._second_sec <= SILENCE_SEC
            # One that has just ended does not count beside the next.
            return State.TWO if two and silent_sec < SILENCE_SEC / 3 else State.HERE
        if another:
            return State.ANOTHER_WORLD
        return State.GONE if silent_sec > SILENCE_SEC else State.HERE


class SceneCheck:
    """Checks every scene of one world, in the order in which they come."""

    def __init__(self, world: World) -> None:
        model = world.model
        self._size = int(model.nq)
        free = model.jnt_type == mujoco.mjtJoint.mjJNT_FREE
        self._quaternions = model.jnt_qposadr[free][:, None] + np.arange(3, 7)
        self._last: tuple[float, Array] | None = None

    def error_in(self, scene: Scene) -> str:
        """
        Return why a scene is invalid, or nothing.

        Only the first scene after a jump is invalid: somebody may have moved the robot.
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
        lengths = np.linalg.norm(scene.qpos[self._quaternions], axis=1)
        if len(lengths) and np.abs(lengths - 1.0).max() > LENGTH_ERROR:
            return 'an orientation is no rotation: its length is not 1'
        return self._jump_in(scene.time_sec, places)

    def _jump_in(self, time_sec: Array, places: Array) -> str:
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


class RealTimeFactor:
    """The achieved real-time factor over the last second of wall time."""

    def __init__(self) -> None:
        self._samples: deque[tuple[float, float]] = deque()

    def add(self, *, wall_sec: float, time_sec: float) -> None:
        """Add a sample; simulated time that goes back begins anew."""
        if self._samples and time_sec < self._samples[-1][1]:
            self._samples.clear()
        self._samples.append((wall_sec, time_sec))
        while wall_sec - self._samples[0][0] > WINDOW_SEC:
            self._samples.popleft()

    @property
    def value(self) -> float | None:
        """Return simulated over wall time; None until there are two samples."""
        if len(self._samples) < 2:
            return None
        (wall_0, time_0), (wall_1, time_1) = self._samples[0], self._samples[-1]
        return (time_1 - time_0) / (wall_1 - wall_0) if wall_1 > wall_0 else None
