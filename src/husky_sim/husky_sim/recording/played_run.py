# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run, put back into the world that it was driven in."""

import math

from husky_course.frames import Array
from husky_course.record import Record, RecordRefused
import numpy as np

from husky_sim.config import DriveConfig
from husky_sim.recording.recorder import loose_bodies
from husky_sim.robot.husky import JOINTS
from husky_sim.world.world import World


class PlayedRun:
    """
    Tells where everything stood.

    A record has the motion in the plane: robots stand upright, at the height of their start.
    """

    def __init__(self, run: Record, world: World) -> None:
        """
        Prepare.

        :raises RecordRefused: if the world lacks something that was pushed.
        """
        self._run = run
        self._places = np.stack(
            [
                [run.column(robot, name) for name in ('x', 'y', 'yaw')]
                for robot in range(len(run.robots))
            ]
        )
        self._turns = [_wheel_turns(run, robot) for robot in range(len(run.robots))]
        self._start = world.model.qpos0.copy()
        self._qpos = self._start.copy()
        self._bases = []
        self._wheels = []
        for robot in run.robots:
            base = int(world.model.joint(f'{robot.name}/base_joint').qposadr[0])
            self._bases.append(base)
            self._wheels.append(
                [int(world.model.joint(f'{robot.name}/{joint}').qposadr[0]) for joint in JOINTS]
            )
        loose = loose_bodies(world)
        for name, push in run.pushed.items():
            if name not in loose or push.qpos.shape[1] != loose[name].stop - loose[name].start:
                raise RecordRefused(
                    f'{run.file}: {name!r} was pushed, but {run.world} has no such loose body '
                    'any more; replay it with the world that was driven'
                )
        self._pushed = [(loose[name], push) for name, push in run.pushed.items()]

    def qpos(self, row: int) -> Array:
        """Return MuJoCo's positions at a row of the record; the next call changes them."""
        run = self._run
        for place, (base, wheels) in enumerate(zip(self._bases, self._wheels, strict=True)):
            x, y, yaw = self._places[place, :, row]
            left, right = self._turns[place][row]
            self._qpos[base : base + 2] = (x, y)
            self._qpos[base + 3 : base + 7] = (math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2))
            self._qpos[wheels] = (left, right, left, right)
        for part, push in self._pushed:
            past = int(np.searchsorted(push.time_sec, run.time_sec[row] + 1e-9, side='right'))
            self._qpos[part] = push.qpos[past - 1] if past else self._start[part]
        return self._qpos


def _wheel_turns(record: Record, robot: int) -> Array:
    """Integrate how far left and right wheels turned, in rad: a record has only the speeds."""
    config = DriveConfig()
    speed, yaw_rate = record.column(robot, 'speed_m_s'), record.column(robot, 'yaw_rate_rad_s')
    across = yaw_rate * config.wheel_separation_m / 2.0
    rates = np.stack([speed - across, speed + across], axis=1) / config.wheel_radius_m
    steps = np.diff(record.time_sec, prepend=record.time_sec[0])
    return np.asarray(np.cumsum(rates * steps[:, None], axis=0))
