# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The record of a run, read and checked; its format is described where it is written."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
import math
from pathlib import Path
from typing import Any

import numpy as np

from husky_course.frames import Array
from husky_course.outline import least_clearance, Outline
from husky_course.record.blocks import read_blocks
from husky_course.record.contents import (
    Collision,
    COLUMNS,
    Disturbance,
    MAX_RATE,
    Overturn,
    Push,
)
from husky_course.record.writer import FILE_NAME, FORMAT, VERSION
from husky_course.robot import RobotStart

SPEED_LIMIT, MOST_LIMIT_M_S = 'speed_limit_m_s:=', 10.0
"""The condition that lets the wheels do another speed than 1 m/s, and the greatest there is."""
FASTER_M_S = 2.0
"""More than this above what the wheels may do is no Husky."""
MAX_POSITION_M = 1e6
MAX_YAW_RAD = 1e6
MAX_OBSTACLES = 10_000
MAX_CONDITIONS = 1000
"""Characters of all of them."""

_BOUNDS = {
    **dict.fromkeys(('x', 'y', 'odom_x', 'odom_y'), MAX_POSITION_M),
    **dict.fromkeys(('yaw', 'odom_yaw'), MAX_YAW_RAD),
    **dict.fromkeys(('speed_m_s', 'yaw_rate_rad_s'), MAX_RATE),
    **dict.fromkeys(('command_speed_m_s', 'command_yaw_rate_rad_s'), MAX_RATE),
}


class RecordRefused(ValueError):
    """A file is no record that a simulation can have written; the message is one line."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Record:
    """A run: one row of `rows` for every control period; the first is the start."""

    file: str
    world: str
    robots: tuple[RobotStart, ...]
    obstacles: tuple[Outline, ...]
    rows: Array  # (periods + 1, robots, len(COLUMNS))
    conditions: tuple[str, ...] = ()  # settings that are not the default, as NAME:=VALUE
    collisions: tuple[Collision, ...] = ()
    pushed: Mapping[str, Push] = field(default_factory=dict)  # by the name of the body
    disturbances: tuple[Disturbance, ...] = ()
    overturns: tuple[Overturn, ...] = ()
    complete: bool = True  # false: the simulator ended before it could say so

    @property
    def time_sec(self) -> Array:
        """The time of every row."""
        return self.rows[:, 0, 0]

    @property
    def duration_sec(self) -> float:
        """The time of the last row."""
        return float(self.rows[-1, 0, 0])

    def column(self, robot: int, name: str) -> Array:
        """Return one column of a robot, a view."""
        return self.rows[:, robot, COLUMNS.index(name)]

    def place_of(self, robot: str | None) -> int:
        """
        Return which of the robots has a name; None asks for the only one.

        :raises RecordRefused: when there is none, or there are several.
        """
        names = [start.name for start in self.robots]
        if robot is None and len(names) > 1:
            raise RecordRefused(
                f'the record has {len(names)} robots; name one of: {", ".join(names)}'
            )
        if robot is not None and robot not in names:
            raise RecordRefused(
                f'robot {robot!r} is not in the record; it has: {", ".join(names)}'
            )
        return 0 if robot is None else names.index(robot)

    @property
    def has_commands(self) -> bool:
        """Whether any robot was told to move."""
        return bool(self._commands.any())

    @property
    def _commands(self) -> Array:
        """Speed and yaw rate that each robot was asked for, in each row."""
        column = COLUMNS.index('command_speed_m_s')
        return self.rows[:, :, column : column + 2]

    def begin(self, robot: int) -> int:
        """Return the entry at which a robot got its first command, or was touched before."""
        commanded = self._commands[:, robot].any(axis=1)
        begin = max(int(commanded.argmax()) - 1, 0)  # an entry holds the command of what it ends
        name = self.robots[robot].name
        first_sec = min((t.time_sec for t in self.collisions if t.robot == name), default=math.inf)
        touched = int(np.searchsorted(self.rows[:, robot, 0], first_sec + 1e-9)) - 1
        return min(begin, max(touched, 0))

    def row_at(self, time_sec: float) -> int:
        """Return the last row at or before a time."""
        return max(int(np.searchsorted(self.time_sec, time_sec + 1e-9, side='right')) - 1, 0)

    def since_first_command(self) -> 'Record':
        """Return the record without what was before the drive; its time begins at 0."""
        begin = min(self.begin(robot) for robot in range(len(self.robots)))
        begin_sec = float(self.time_sec[begin])
        rows = self.rows[begin:].copy()
        rows[:, :, 0] -= begin_sec
        collisions, disturbances, overturns = self.events_since(begin_sec)
        pushed = {
            name: replace(push, time_sec=push.time_sec - begin_sec)
            for name, push in self.pushed.items()
        }
        return replace(
            self,
            rows=rows,
            collisions=collisions,
            pushed=pushed,
            disturbances=disturbances,
            overturns=overturns,
        )

    def events_since(
        self, begin_sec: float
    ) -> tuple[tuple[Collision, ...], tuple[Disturbance, ...], tuple[Overturn, ...]]:
        """Return the events with times since the drive began; others were there by then."""
        return (
            tuple(replace(each, time_sec=each.time_sec - begin_sec) for each in self.collisions),
            tuple(
                replace(each, time_sec=max(each.time_sec - begin_sec, 0.0))
                for each in self.disturbances
            ),
            tuple(replace(each, time_sec=each.time_sec - begin_sec) for each in self.overturns),
        )

    def min_clearance_m(self, robot: int) -> float | None:
        """Return how near a robot came to an obstacle; None where there is none."""
        if not self.obstacles:
            return None
        first = COLUMNS.index('x')
        return least_clearance(self.rows[:, robot, first : first + 3], self.obstacles)


def read_record(path: str | Path) -> Record:
    """
    Read a record, or the one in a report's folder.

    :raises RecordRefused: if there is none, or no simulation can have written it.
    """
    file = Path(path)
    if file.is_dir():
        file = file / FILE_NAME
    try:
        if file.exists() and not file.is_file():
            raise RecordRefused(f'{file}: not a file; give the record of a run')
        with file.open('rb') as stream:
            return _read(str(file), read_blocks(stream), file.stat().st_size)
    except OSError as error:
        raise RecordRefused(
            f'{file}: cannot be read: {error.strerror}; give the record of a run, or the folder '
            'of its report'
        ) from error
    except RecordRefused:
        raise
    except (ValueError, KeyError, TypeError, OverflowError, MemoryError) as error:
        near = file.with_name(FILE_NAME)
        is_beside = near != file and near.is_file()
        mend = f'{near} beside it is one' if is_beside else 'drive it again'
        raise RecordRefused(
            f'{file}: damaged, or not the record of a run ({error}); {mend}'
        ) from error


def _read(file: str, blocks: Iterator[Any], size: int) -> Record:
    header = next(blocks, None)
    if not isinstance(header, dict) or header.get('format') != FORMAT:
        raise ValueError(f'format is not {FORMAT!r}')
    if header['version'] != VERSION:
        raise RecordRefused(
            f'{file}: version {header["version"]!r}, but only {VERSION} is known here; drive again'
        )
    if tuple(header['columns']) != COLUMNS:
        raise ValueError('other columns')
    robots = tuple(_robot(entry) for entry in header['robots'])
    if not robots:
        raise ValueError('no robots')
    table = np.empty((size // (8 * len(robots) * len(COLUMNS)), len(robots), len(COLUMNS)))
    count, events = 0, _Events(frozenset(robot.name for robot in robots))
    for block in blocks:
        if isinstance(block, np.ndarray):
            if block.shape[1:] != table.shape[1:]:
                raise ValueError('a table of another shape')
            table[count : count + len(block)] = block
            count += len(block)
        else:
            events.take(block)
    rows = table[:count]
    conditions = _conditions(header['conditions'])
    period_sec = _number(header['control_period_sec'])
    _check_rows(rows, robots, period_sec, most_m_s=_limit_m_s(conditions) + FASTER_M_S)
    return Record(
        file=file,
        world=_text(header['world']),
        conditions=conditions,
        robots=robots,
        obstacles=_outlines(header['obstacles']),
        rows=rows,
        collisions=events.collisions(float(rows[-1, 0, 0])),
        pushed=events.pushed(),
        disturbances=tuple(events.disturbances),
        overturns=tuple(events.overturns),
        complete=events.complete,
    )


class _Events:
    """Collects what happened between the rows."""

    def __init__(self, robots: frozenset[str]) -> None:
        self._robots = robots
        self._touches: list[Collision] = []
        self._pushes: dict[str, tuple[list[float], list[list[float]]]] = {}
        self.disturbances: list[Disturbance] = []
        self.overturns: list[Overturn] = []
        self.complete = False

    def take(self, events: Any) -> None:
        for event in events:
            kind = event['event']
            if kind == 'collision':
                self._touches.append(self._touch(event))
            elif kind == 'pushed':
                times, poses = self._pushes.setdefault(_text(event['body']), ([], []))
                times.append(_number(event['time_sec']))
                poses.append([_number(value) for value in event['qpos']])
            elif kind == 'disturbance':
                self.disturbances.append(_disturbance(event))
            elif kind == 'overturn':
                self.overturns.append(
                    Overturn(robot=self._robot(event), time_sec=_number(event['time_sec']))
                )
            elif kind == 'end':
                self.complete = True
            else:
                raise ValueError(f'unknown event {kind!r}')

    def _touch(self, event: Mapping[str, Any]) -> Collision:
        x, y, z = (_number(value) for value in event['position'])
        return Collision(
            robot=self._robot(event),
            obstacle=_text(event['obstacle']),
            part=_text(event['part']),
            time_sec=_number(event['time_sec']),
            force_n=_number(event['force_n']),
            position=(x, y, z),
        )

    def _robot(self, event: Mapping[str, Any]) -> str:
        name = event['robot']
        if name not in self._robots:
            raise ValueError(f'{event["event"]} of {name!r}, which is no robot of the run')
        return str(name)

    def collisions(self, end_sec: float) -> tuple[Collision, ...]:
        """Return them in order; of a record that was cut off, those that its rows reach."""
        if any(touch.time_sec < 0.0 for touch in self._touches):
            raise ValueError('a collision before the run')
        inside = [touch for touch in self._touches if touch.time_sec <= end_sec + 1e-9]
        if self.complete and len(inside) < len(self._touches):
            raise ValueError('a collision after the run')
        return tuple(sorted(inside, key=lambda touch: touch.time_sec))

    def pushed(self) -> dict[str, Push]:
        return {
            name: Push(time_sec=np.array(times), qpos=np.array(poses, dtype=np.float64))
            for name, (times, poses) in self._pushes.items()
        }


def _check_rows(
    rows: Array, robots: tuple[RobotStart, ...], period_sec: float, *, most_m_s: float
) -> None:
    """Refuse what no simulation gives: holes, NaN, time that runs back, jumps."""
    if not len(rows):
        raise ValueError('no entries')
    if not np.isfinite(rows).all():
        raise ValueError('NaN or infinity among its numbers')
    for name, most in _BOUNDS.items():
        column = np.abs(rows[:, :, COLUMNS.index(name)])
        if column.max() > most:
            raise ValueError(f'{name} of {column.max():.3g}, but {most:g} is the most')
    time = rows[:, :, 0]
    steps = np.diff(time, axis=0)
    if not 0.0 < period_sec <= 1.0 or time.min() < 0.0 or (np.ptp(time, axis=1) > 0.0).any():
        raise ValueError('times that are none')
    if (wrong := np.flatnonzero(np.abs(steps - period_sec).max(axis=1, initial=0.0) > 1e-6)).size:
        begin, end = time[wrong[0] : wrong[0] + 2, 0]
        raise ValueError(f'its time goes from {begin:.2f} s to {end:.2f} s in one step')
    most_m = most_m_s * period_sec + 1e-3
    for place, robot in enumerate(robots):
        for name in ('x', 'odom_x'):
            first = COLUMNS.index(name)
            way = np.diff(rows[:, place, first : first + 2], axis=0)
            jumps = np.flatnonzero(np.hypot(way[:, 0], way[:, 1]) > most_m)
            if jumps.size:
                raise ValueError(
                    f'{robot.name} jumps {np.hypot(*way[jumps[0]]):.2f} m at '
                    f'{time[jumps[0] + 1, 0]:.2f} s, which no Husky can'
                )


def _robot(entry: Mapping[str, Any]) -> RobotStart:
    x, y, yaw = _pose(entry['start'])
    return RobotStart(name=_text(entry['name']), x=x, y=y, yaw=yaw)


def _outlines(entries: Any) -> tuple[Outline, ...]:
    if len(entries) > MAX_OBSTACLES:
        raise ValueError(f'{len(entries)} obstacles, but {MAX_OBSTACLES} are the most')
    return tuple(_outline(entry) for entry in entries)


def _outline(entry: Mapping[str, Any]) -> Outline:
    x, y, yaw = _pose([entry[name] for name in ('x', 'y', 'yaw')])
    size = tuple(_number(value) for value in entry['size'])
    if len(size) not in (1, 2):
        raise ValueError('an obstacle that is neither circle nor rectangle')
    if min(size) <= 0.0 or max(size) > MAX_POSITION_M:
        raise ValueError(f'an obstacle of the size {size}')
    return Outline(name=_text(entry['name']), x=x, y=y, yaw=yaw, size=size)


def _disturbance(event: Mapping[str, Any]) -> Disturbance:
    return Disturbance(
        time_sec=_number(event['time_sec']),
        topic=_text(event['topic']),
        nodes=tuple(_text(name) for name in event['nodes']),
    )


def _pose(values: Any) -> tuple[float, float, float]:
    x, y, yaw = (_number(value) for value in values)
    if max(abs(x), abs(y)) > MAX_POSITION_M or abs(yaw) > MAX_YAW_RAD:
        raise ValueError(f'a place at ({x:.3g}, {y:.3g}) with yaw {yaw:.3g}')
    return x, y, yaw


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f'{value!r:.40} instead of a number')
    return float(value)


def _conditions(given: Iterable[Any]) -> tuple[str, ...]:
    conditions = tuple(map(_text, given))
    if sum(map(len, conditions)) > MAX_CONDITIONS:
        raise ValueError(f'conditions longer than {MAX_CONDITIONS} characters')
    return conditions


def _limit_m_s(conditions: tuple[str, ...]) -> float:
    """Return how fast the wheels may be: 1 m/s, but where the run was driven with more."""
    given = [each.removeprefix(SPEED_LIMIT) for each in conditions if each.startswith(SPEED_LIMIT)]
    limit_m_s = max(map(float, given), default=1.0)
    if not 0.0 <= limit_m_s <= MOST_LIMIT_M_S:  # also of nan
        raise ValueError(f'a speed limit of {limit_m_s:g} m/s')
    return max(limit_m_s, 1.0)


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f'{value!r:.40} instead of a text')
    value.encode()  # half a surrogate pair cannot be: UnicodeEncodeError is a ValueError
    return value
