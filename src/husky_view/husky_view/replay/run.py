# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run, as it is replayed: read, checked, and asked for what was at a time."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
import math

from husky_course.record import Collision, COLUMNS, Push, read_record, RecordRefused
from husky_course.robot import RobotStart
from husky_sim.recording import loose_bodies
from husky_sim.robot import JOINTS
from husky_sim.scene_topic import Scene, TRACK
from husky_sim.world import World
import numpy as np
import numpy.typing as npt

from husky_sim.config import DriveConfig

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Run:
    """What a record holds of a run, as far as it is to be seen: from the first command on."""

    file: str
    world: str
    robots: tuple[RobotStart, ...]
    time_sec: Array  # since the first command, as in the report
    track: Array  # shape (entries, robots, len(TRACK))
    turns: Array  # shape (entries, robots, 2): how far left and right wheels turned, in rad
    collisions: tuple[Collision, ...]
    pushed: Mapping[str, Push]  # by the name of the body

    @property
    def duration_sec(self) -> float:
        """Return how long the run was."""
        return float(self.time_sec[-1])

    def entry_at(self, time_sec: float) -> int:
        """Return the last entry at or before a time."""
        return max(int(np.searchsorted(self.time_sec, time_sec + 1e-9, side='right')) - 1, 0)


def load_run(path: str) -> Run:
    """
    Read a record, or the one in a report's folder.

    :raises RecordRefused: if there is none, or it is not one of ours.
    """
    record = read_record(path)
    begin = min(record.begin(place) for place in range(len(record.robots)))
    rows = record.rows[begin:]
    begin_sec = float(rows[0, 0, 0])
    first = COLUMNS.index(TRACK[0])
    return Run(
        file=record.file,
        world=record.world,
        robots=record.robots,
        time_sec=rows[:, 0, 0] - begin_sec,
        track=rows[:, :, first : first + len(TRACK)],
        turns=np.stack([_wheel_turns(rows[:, place]) for place in range(rows.shape[1])], axis=1),
        collisions=tuple(
            replace(collision, time_sec=collision.time_sec - begin_sec)
            for collision in record.collisions
        ),
        pushed={
            name: Push(time_sec=push.time_sec - begin_sec, qpos=push.qpos)
            for name, push in record.pushed.items()
        },
    )


def _wheel_turns(table: Array) -> Array:
    """Reckon how far the wheels turned, from the speeds: a record does not keep it."""
    config = DriveConfig()
    speed, yaw_rate = (table[:, COLUMNS.index(name)] for name in ('speed_m_s', 'yaw_rate_rad_s'))
    across = yaw_rate * config.wheel_separation_m / 2.0
    rates = np.stack([speed - across, speed + across], axis=1) / config.wheel_radius_m
    steps = np.diff(table[:, 0], prepend=table[0, 0])
    return np.asarray(np.cumsum(rates * steps[:, None], axis=0))


class RunScenes:
    """
    Makes the scenes of a run.

    :raises RecordRefused: if the world lacks something that was pushed.
    """

    def __init__(self, run: Run, world: World) -> None:
        self._run = run
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
            x, y, yaw = run.track[last, place, :3]
            left, right = run.turns[last, place]
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
            track=run.track[rows],
        )
