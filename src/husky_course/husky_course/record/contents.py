# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a record holds of a run: a row a control period, and the events between two rows."""

from dataclasses import dataclass, fields
from typing import Generic, TypeVar

from husky_course.frames import Array

Value = TypeVar('Value')

MAX_RATE = 1e3
"""Of speeds and yaw rates, m/s and rad/s; who asks for more is recorded as asking for so much."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Columns(Generic[Value]):
    """What is recorded of a robot, in the order of the file: a number each, or an array each."""

    time_sec: Value
    x: Value  # true pose
    y: Value
    yaw: Value
    odom_x: Value
    odom_y: Value
    odom_yaw: Value
    speed_m_s: Value
    yaw_rate_rad_s: Value
    command_speed_m_s: Value
    command_yaw_rate_rad_s: Value


class Row(Columns[float]):
    """One row; a class, since to call `Columns[float]` takes twice as long."""


COLUMNS = tuple(column.name for column in fields(Columns))


@dataclass(frozen=True, kw_only=True)
class Collision:
    """One collision: when and where it began, and how hard it was."""

    robot: str
    obstacle: str
    part: str
    time_sec: float
    force_n: float
    position: tuple[float, float, float]

    def __str__(self) -> str:
        return f'{self.obstacle} ({self.part}, {self.force_n:.0f} N) at {self.time_sec:.1f} s'


@dataclass(frozen=True, kw_only=True)
class Disturbance:
    """Another node published on a topic of this run: when it was noticed, where, and who."""

    time_sec: float
    topic: str
    nodes: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Overturn:
    """A robot turned over: it lies on a side or on its top, until the end of the run."""

    robot: str
    time_sec: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Push:
    """Where a body went that was pushed."""

    time_sec: Array
    qpos: Array  # (n, joint coordinates of the body)
