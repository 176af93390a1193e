# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A course, and the table of fields that a waypoint file may hold.

The checker reads by this table; the JSON schema for editors is made from it, see `schema`.
"""

from __future__ import annotations

from dataclasses import dataclass, field

MIN_SPEED_M_S = 0.05
MAX_SPEED_M_S = 1.0  # the velocity controller's limit
MAX_COORDINATE_M = 1000.0
MAX_WAYPOINTS = 1000


@dataclass(frozen=True)
class Waypoint:
    """A place to drive through, in the frame `odom`; `line` is where the file names it."""

    x_m: float
    y_m: float
    speed_m_s: float | None = None  # on the way to this waypoint; None: the course's speed
    yaw_rad: float | None = None  # stop here and turn to this heading
    dwell_sec: float = 0.0  # stand here for so long
    reverse: bool = False  # drive backwards on the way to this waypoint
    line: int = 0


@dataclass(frozen=True)
class Course:
    """What a waypoint file asks for."""

    name: str
    waypoints: tuple[Waypoint, ...]
    frame: str = 'odom'
    speed_m_s: float = 0.5
    tolerance_m: float = 0.25
    loop: bool = False
    corners: str = 'smooth'
    file: str = field(default='', compare=False)

    @property
    def stops(self) -> tuple[Waypoint, ...]:
        """Waypoints in the order of driving; a loop comes back to the first."""
        return (*self.waypoints, self.waypoints[0]) if self.loop else self.waypoints


@dataclass(frozen=True)
class Number:
    """A field with a number in a range."""

    attribute: str
    description: str
    low: float
    high: float
    unit: str


@dataclass(frozen=True)
class Choice:
    """A field with one of some words."""

    attribute: str
    description: str
    words: tuple[str, ...]


@dataclass(frozen=True)
class Truth:
    """A field that is true or false."""

    attribute: str
    description: str


@dataclass(frozen=True)
class Waypoints:
    """The list of waypoints: each a pair [x, y], or a mapping of WAYPOINT_FIELDS."""

    attribute: str
    description: str
    least: int
    most: int


Field = Number | Choice | Truth | Waypoints

REQUIRED_OF_A_WAYPOINT = ('x', 'y')
WAYPOINT_FIELDS: dict[str, Field] = {
    'x': Number('x_m', 'm forward of the start.', -MAX_COORDINATE_M, MAX_COORDINATE_M, 'm'),
    'y': Number('y_m', 'm left of the start.', -MAX_COORDINATE_M, MAX_COORDINATE_M, 'm'),
    'speed': Number(
        'speed_m_s', 'm/s on the way to this waypoint.', MIN_SPEED_M_S, MAX_SPEED_M_S, 'm/s'
    ),
    'yaw': Number(
        'yaw_rad',
        'rad: stop here and turn to this heading; not for the first, unless loop is true.',
        *(-6.2832, 6.2832, 'rad'),
    ),
    'dwell': Number(
        'dwell_sec',
        's: stand here for so long; not for the first, unless loop is true.',
        *(0.0, 600.0, 's'),
    ),
    'reverse': Truth('reverse', 'true: drive backwards on the way to this waypoint.'),
}
COURSE_FIELDS: dict[str, Field] = {
    'frame': Choice('frame', 'The frame of the coordinates.', ('odom',)),
    'speed': Number('speed_m_s', 'm/s along the path.', MIN_SPEED_M_S, MAX_SPEED_M_S, 'm/s'),
    'tolerance': Number(
        'tolerance_m', 'm, how near to a waypoint counts as reached.', 0.05, 1.0, 'm'
    ),
    'loop': Truth('loop', 'true: come back to the first waypoint.'),
    'corners': Choice(
        'corners',
        'smooth: one curve through all waypoints, but a turn of more than 120 degrees, or tighter '
        'than 5 cm of radius, is made on the spot; sharp: straight lines and turns on the spot.',
        ('smooth', 'sharp'),
    ),
    'waypoints': Waypoints(
        'waypoints', 'The places to drive through, in order.', 2, MAX_WAYPOINTS
    ),
}
