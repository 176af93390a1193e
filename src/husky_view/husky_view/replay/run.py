# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The scenes of a recorded run."""

import math

from husky_course.frames import Array
from husky_course.record import COLUMNS, read_record, Record, RecordRefused
from husky_sim.recording import loose_bodies
from husky_sim.robot import JOINTS
from husky_sim.scene_topic import Scene, TRACK
from husky_sim.world import World
import numpy as np

from husky_sim.config import DriveConfig


def load_run(path: str) -> Record:
    """
    Read a record, or the one in a report's folder, from the first command on.

    :raises RecordRefused: if there is none, or it is not one of ours.
    """
    return read_record(path).since_first_command()


def _wheel_turns(record: Record, robot: int) -> Array:
    """Integrate how far left and right wheels turned, in rad: a record has only the speeds."""
    config = DriveConfig()
    speed, yaw_rate = record.column(robot, 'speed_m_s'), record.column(robot, 'yaw_rate_rad_s')
    across = yaw_rate * config.wheel_separation_m / 2.0
    rates = np.stack([speed - across, speed + across], axis=1) / config.wheel_radius_m
    steps = np.diff(record.time_sec, prepend=record.time_sec[0])
    return np.asarray(np.cumsum(rates * steps[:, None], axis=0))


class RunScenes:
    """
    Makes the scenes of a run.

    :raises RecordRefused: if the world lacks something that was pushed.
    """

    def __init__(self, run: Record, world: World) -> None:
        self._run = run
        first = COLUMNS.index(TRACK[0])
        self._track = run.rows[:, :, first : first + len(TRACK)]
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

    def scene(self, first: int, last: int, *, paused: bool) -> Scene:
        """Return the scene at entry `last`, with the track from entry `first` on."""
        run = self._run
        for place, (base, wheels) in enumerate(zip(self._bases, self._wheels, strict=True)):
            x, y, yaw = self._track[last, place, :3]
            left, right = self._turns[place][last]
            self._qpos[base : base + 2] = (x, y)
            self._qpos[base + 3 : base + 7] = (math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2))
            self._qpos[wheels] = (left, right, left, right)
        for part, push in self._pushed:
            past = int(np.searchsorted(push.time_sec, run.time_sec[last] + 1e-9, side='right'))
            self._qpos[part] = push.qpos[past - 1] if past else self._start[part]
        rows = slice(first, last + 1)
        return Scene(
            paused=paused,
            qpos=self._qpos,
            time_sec=run.time_sec[rows],
            track=self._track[rows],
        )
