# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator's record of a run, checked, seen in the robot's own frame `odom`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import hashlib
import json
import math
from pathlib import Path
import struct
from typing import Any

FORMAT, VERSION = 'husky_playpen_record', 1
COLUMNS = (
    *('time_sec', 'x', 'y', 'yaw', 'odom_x', 'odom_y', 'odom_yaw', 'speed_m_s'),
    *('yaw_rate_rad_s', 'command_speed_m_s', 'command_yaw_rate_rad_s'),
)


class RecordRefused(ValueError):
    """A record that cannot be judged."""


@dataclass(frozen=True)
class Collision:
    """One touch: what was touched with which part of the robot, when, how hard and where."""

    obstacle: str
    part: str
    time_sec: float
    force_n: float
    position: tuple[float, float, float]


@dataclass(frozen=True)
class Outline:
    """An obstacle seen from above: a circle of one size or a rectangle of two, world frame."""

    name: str
    type: str
    x: float
    y: float
    yaw: float
    size: tuple[float, ...]


@dataclass(frozen=True)
class RunRecord:
    """One robot's run; every list has one entry a control period."""

    time_sec: list[float]
    x: list[float]  # true pose in the frame the robot's odometry started in
    y: list[float]
    yaw: list[float]
    odom_x: list[float]
    odom_y: list[float]
    odom_yaw: list[float]
    speed_m_s: list[float]
    yaw_rate_rad_s: list[float]
    command_speed_m_s: list[float]
    command_yaw_rate_rad_s: list[float]
    start: tuple[float, float, float]  # in the frame world
    collisions: tuple[Collision, ...]
    obstacles: tuple[Outline, ...]
    min_clearance_m: float | None
    trajectory_sha256: str

    def to_world(self, x: float, y: float) -> tuple[float, float]:
        x0, y0, yaw0 = self.start
        cos, sin = math.cos(yaw0), math.sin(yaw0)
        return x0 + cos * x - sin * y, y0 + sin * x + cos * y

    def to_odom(self, x: float, y: float) -> tuple[float, float]:
        x0, y0, yaw0 = self.start
        cos, sin = math.cos(yaw0), math.sin(yaw0)
        return cos * (x - x0) + sin * (y - y0), cos * (y - y0) - sin * (x - x0)


def load_record(path: str | Path) -> dict[str, Any]:
    """
    Return the content of a record file.

    :raises RecordRefused: when it is no record.
    """
    try:
        record = json.loads(Path(path).read_text(encoding='utf-8'))
    except OSError as error:
        raise RecordRefused(f'{path}: cannot be read: {error.strerror}') from None
    except (ValueError, RecursionError) as error:
        raise RecordRefused(f'{path}: not JSON: {error}') from None
    if not isinstance(record, dict) or record.get('format') != FORMAT:
        raise RecordRefused(
            f"{path}: not a record of the simulator; give what its parameter 'record' wrote"
        )
    if record.get('version') != VERSION:
        raise RecordRefused(f'{path}: version {record.get("version")!r}; this one reads {VERSION}')
    return record


def read_run(record: Mapping[str, Any], robot: str | None = None) -> RunRecord:
    """
    Return one robot's run.

    :param robot: its name; None takes the only one.
    :raises RecordRefused: when the robot or a part of the record is missing.
    """
    try:
        name = robot or _only_robot(record['robots'])
        if name not in record['robots']:
            names = ', '.join(record['robots'])
            raise RecordRefused(f'robot {name!r} is not in the record; it has: {names}')
        table = {column: _column(record['robots'][name][column]) for column in COLUMNS}
        if len({len(column) for column in table.values()}) != 1 or not table['x']:
            raise RecordRefused('the columns of the record differ in length or are empty')
        start = tuple(_column(record['start'][name]))
        return _assemble(record, name, table, (start[0], start[1], start[2]))
    except (KeyError, IndexError, TypeError, AttributeError) as error:
        raise RecordRefused(f'the record lacks {error}') from None


def _assemble(
    record: Mapping[str, Any],
    name: str,
    table: dict[str, list[float]],
    start: tuple[float, float, float],
) -> RunRecord:
    world = list(zip(table['time_sec'], table['x'], table['y'], table['yaw'], strict=True))
    digest = hashlib.sha256(b''.join(struct.pack('<4d', *entry) for entry in world)).hexdigest()
    cos, sin = math.cos(start[2]), math.sin(start[2])
    moved = [(x - start[0], y - start[1]) for _, x, y, _ in world]
    table['x'] = [cos * x + sin * y for x, y in moved]
    table['y'] = [cos * y - sin * x for x, y in moved]
    table['yaw'] = [math.remainder(yaw - start[2], 2 * math.pi) for *_, yaw in world]
    clearance = record.get('min_clearance_m', {}).get(name)
    return RunRecord(
        **table,
        start=start,
        collisions=tuple(
            _collision(entry) for entry in record['collisions'] if entry['robot'] == name
        ),
        obstacles=tuple(
            Outline(o['name'], o['type'], o['x'], o['y'], o['yaw'], tuple(o['size']))
            for o in record['obstacles']
        ),
        min_clearance_m=None if clearance is None else float(clearance),
        trajectory_sha256=digest,
    )


def _collision(entry: Mapping[str, Any]) -> Collision:
    x, y, z = _column(entry['position'])
    return Collision(
        entry['obstacle'], entry['part'], entry['time_sec'], entry['force_n'], (x, y, z)
    )


def _only_robot(robots: Mapping[str, Any]) -> str:
    if len(robots) != 1:
        raise RecordRefused(
            f'the record has {len(robots)} robots; name one of: {", ".join(robots)}'
        )
    return next(iter(robots))


def _column(values: Sequence[float]) -> list[float]:
    return [float(value) for value in values]
