# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run, as it is replayed: read, checked, and asked for what was at a time."""

from collections.abc import Mapping
from dataclasses import dataclass
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from husky_sim.config import DriveConfig, RobotStart
from husky_sim.husky import JOINTS
from husky_sim.pushed import loose_bodies
from husky_sim.record import FORMAT, VERSION
from husky_sim.scene_topic import Scene, TRACK
from husky_sim.view.collisions import Collision
from husky_sim.world import World

RECORD_FILE = 'record.json'

Array = npt.NDArray[np.float64]

_COLUMNS = ('time_sec', *TRACK, 'yaw_rate_rad_s')


class RunRefused(Exception):
    """A file is no record of a run; the message is one line for a person."""


@dataclass(frozen=True, kw_only=True)
class Push:
    """Where a body went that was pushed."""

    time_sec: Array
    qpos: Array  # (n, joint coordinates of the body)


@dataclass(frozen=True, kw_only=True)
class Run:
    """What a record holds of a run, as far as it is to be seen."""

    file: str
    world: str
    robots: tuple[RobotStart, ...]
    time_sec: Array
    track: Array  # shape (entries, robots, len(TRACK))
    turns: Array  # shape (entries, robots, 2): how far left and right wheels turned, in rad
    collisions: tuple[Collision, ...]
    pushed: dict[str, Push]  # by the name of the body

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

    :raises RunRefused: if there is none, or it is not one of ours.
    """
    file = Path(path)
    if file.is_dir():
        file = file / RECORD_FILE
    try:
        record = json.loads(file.read_text(encoding='utf-8'))
    except OSError as error:
        raise RunRefused(
            f'{file}: {error.strerror}; give the record of a run, or the folder of its report'
        ) from error
    except ValueError as error:
        raise RunRefused(f'{file}: not JSON ({error}); give the record of a run') from error
    if not isinstance(record, dict) or record.get('format') != FORMAT:
        raise RunRefused(f'{file}: not the record of a run (format is not {FORMAT!r})')
    if record.get('version') != VERSION:
        raise RunRefused(
            f'{file}: version {record.get("version")!r}; only {VERSION} is known here'
        )
    try:
        return _run_of(str(file), record)
    except (KeyError, TypeError, ValueError) as error:
        raise RunRefused(f'{file}: damaged record ({type(error).__name__}: {error})') from error


def _run_of(file: str, record: Mapping[str, Any]) -> Run:
    robots = record['robots']
    tables = [
        np.array([robots[name][column] for column in _COLUMNS], dtype=np.float64).T
        for name in robots
    ]
    if not tables or not len(tables[0]) or not all(np.isfinite(table).all() for table in tables):
        raise ValueError('no entries, or entries that are not finite')
    columns = len(TRACK)
    return Run(
        file=file,
        world=record['world'],
        robots=tuple(_start(name, record['start'][name]) for name in robots),
        time_sec=tables[0][:, 0],
        track=np.stack([table[:, 1 : 1 + columns] for table in tables], axis=1),
        turns=np.stack([_wheel_turns(table) for table in tables], axis=1),
        collisions=tuple(_collision(entry) for entry in record['collisions']),
        # What was recorded before this was kept: nothing is known to have moved.
        pushed={name: _push(entry) for name, entry in record.get('pushed', {}).items()},
    )


def _push(entry: Mapping[str, Any]) -> Push:
    time_sec, qpos = (np.array(entry[name], dtype=np.float64) for name in ('time_sec', 'qpos'))
    if qpos.ndim != 2 or len(qpos) != len(time_sec) or not np.isfinite(qpos).all():
        raise ValueError('a pushed body without its poses')
    return Push(time_sec=time_sec, qpos=qpos)


def _start(name: str, pose: list[float]) -> RobotStart:
    x, y, yaw = pose
    return RobotStart(name=name, x=float(x), y=float(y), yaw=float(yaw))


def _wheel_turns(table: Array) -> Array:
    """Reckon how far the wheels turned, from the speeds: a record does not keep it."""
    config = DriveConfig()
    speed, yaw_rate = table[:, 1 + TRACK.index('speed_m_s')], table[:, 1 + len(TRACK)]
    across = yaw_rate * config.wheel_separation_m / 2.0
    rates = np.stack([speed - across, speed + across], axis=1) / config.wheel_radius_m
    steps = np.diff(table[:, 0], prepend=table[0, 0])
    return np.asarray(np.cumsum(rates * steps[:, None], axis=0))


def _collision(entry: Mapping[str, Any]) -> Collision:
    x, y, z = entry['position']
    return Collision(
        robot=str(entry['robot']),
        obstacle=str(entry['obstacle']),
        part=str(entry['part']),
        time_sec=float(entry['time_sec']),
        force_n=float(entry['force_n']),
        position=(float(x), float(y), float(z)),
    )


class Poser:
    """
    Makes the scenes of a run.

    :raises RunRefused: if the world lacks something that was pushed.
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
                raise RunRefused(
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
