# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A course, and the tables of the fields that a waypoint file may hold.

The checker reads by them; the JSON schema for editors is made from them, see `schema`.
"""

from dataclasses import dataclass, field

from husky_course.checked_yaml import Field, number, Table

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


_COORDINATE = number(-MAX_COORDINATE_M, MAX_COORDINATE_M)
_SPEED = number(MIN_SPEED_M_S, MAX_SPEED_M_S)
_TRUTH = {'type': 'boolean'}
_NOT_FIRST = 'not for the first, unless loop is true.'

_WAYPOINT_FIELDS = {
    'x': Field('x_m', 'm forward of the start.', _COORDINATE, 'm'),
    'y': Field('y_m', 'm left of the start.', _COORDINATE, 'm'),
    'speed': Field('speed_m_s', 'm/s on the way to this waypoint.', _SPEED, 'm/s'),
    'yaw': Field(
        'yaw_rad',
        f'rad: stop here and turn to this heading; {_NOT_FIRST}',
        number(-6.2832, 6.2832),
        'rad',
    ),
    'dwell': Field('dwell_sec', f's: stand here for so long; {_NOT_FIRST}', number(0, 600), 's'),
    'reverse': Field('reverse', 'true: drive backwards on the way to this waypoint.', _TRUTH),
}
_COURSE_FIELDS = {
    'frame': Field('frame', 'The frame of the coordinates.', {'enum': ('odom',)}),
    'speed': Field('speed_m_s', 'm/s along the path.', _SPEED, 'm/s'),
    'tolerance': Field(
        'tolerance_m', 'm, how near to a waypoint counts as reached.', number(0.05, 1.0), 'm'
    ),
    'loop': Field('loop', 'true: come back to the first waypoint.', _TRUTH),
    'corners': Field(
        'corners',
        'smooth: one curve through all waypoints, but a turn of more than 120 degrees, or tighter '
        'than 5 cm of radius, is made on the spot; sharp: straight lines and turns on the spot.',
        {'enum': ('smooth', 'sharp')},
    ),
    'waypoints': Field(
        'waypoints',
        'The places to drive through, in order.',
        {'type': 'array', 'minItems': 2, 'maxItems': MAX_WAYPOINTS},
        example='- [x, y]',
    ),
}
WAYPOINT = Table('waypoint', Waypoint, _WAYPOINT_FIELDS, ('x', 'y'))
COURSE = Table('waypoint file', Course, _COURSE_FIELDS, ('waypoints',))
