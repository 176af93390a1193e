# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Cut a course into legs: stretches driven in one go, with a stop at the end of each.

A leg ends where the robot has to stand: at a sharp corner, where it begins or ends to drive
backwards, at a waypoint with a yaw or a dwell, and at the end of the course. A corner that is too
tight for a smooth curve is a sharp one, whatever the course says: of one that turns right back
the curve would be a cusp, which no robot can follow.
"""

from dataclasses import dataclass
from itertools import pairwise
import math

from husky_course.route.path import Curve, Point, smooth_curve
from husky_course.waypoints.course import Course, Waypoint

SHARP_CORNER_RAD = math.radians(3.0)  # straighter than this needs no stop
# Found by driving random courses in the empty world: with these, 500 of 500 end, at most 5 cm off
# the path; without the second, 1 in 7 is more than 6 cm off; without both, some never end.
TURN_BACK_RAD = math.radians(120.0)  # more than this is done on the spot
TIGHTEST_PER_M = 20.0  # curvature: so is a bend with less than 5 cm of radius
AT_FIRST_M = 0.25  # so near, the path begins where the robot is; a tolerance may be a metre


@dataclass(frozen=True)
class Leg:
    """One stretch; `first` is the number of the waypoint (in `Course.stops`) it begins at."""

    curve: Curve
    speeds_m_s: tuple[float, ...]  # wished, of each piece between two waypoints
    first: int
    reverse: bool = False
    end_yaw_rad: float | None = None
    dwell_sec: float = 0.0

    @property
    def last(self) -> int:
        return self.first + len(self.speeds_m_s)

    @property
    def begin_yaw_rad(self) -> float:
        """How the robot faces where it begins to drive."""
        return self.curve.heading[0] + (math.pi if self.reverse else 0.0)

    @property
    def arrival_yaw_rad(self) -> float:
        """How it faces where the curve ends, before it turns."""
        return self.curve.heading[-1] + (math.pi if self.reverse else 0.0)


def legs_of(course: Course) -> tuple[Leg, ...]:
    """Return the legs from the first waypoint to the last."""
    stops = course.stops
    cuts = [0, *(i for i in range(1, len(stops) - 1) if _is_cut(course, i)), len(stops) - 1]
    whole = course.loop and len(cuts) == 2 and not _is_too_tight(stops[-2], stops[0], stops[1])
    legs = []
    for begin, end in pairwise(cuts):
        part = stops[begin : end + 1]
        points = [(point.x_m, point.y_m) for point in part]
        curve = smooth_curve(points[:-1] if whole else points, closed=whole)
        speeds = tuple(point.speed_m_s or course.speed_m_s for point in part[1:])
        goal = part[-1]
        legs.append(Leg(curve, speeds, begin, goal.reverse, goal.yaw_rad, goal.dwell_sec))
    return tuple(legs)


def lead_in(course: Course, start: Point) -> Leg | None:
    """Return the straight way to the first waypoint, or None when the robot is at it."""
    first = course.waypoints[0]
    goal = (first.x_m, first.y_m)
    if math.dist(start, goal) <= min(course.tolerance_m, AT_FIRST_M):
        return None
    speed = first.speed_m_s or course.speed_m_s
    return Leg(smooth_curve([start, goal]), (speed,), -1, first.reverse)


def _is_cut(course: Course, i: int) -> bool:
    before, here, after = course.stops[i - 1 : i + 2]
    if here.yaw_rad is not None or here.dwell_sec > 0.0 or here.reverse != after.reverse:
        return True
    if course.corners == 'sharp' and _corner(before, here, after) > SHARP_CORNER_RAD:
        return True
    return _is_too_tight(before, here, after)


def _is_too_tight(before: Waypoint, here: Waypoint, after: Waypoint) -> bool:
    """
    Tell whether a curve cannot be driven through a corner.

    The curvature is that of the centripetal Catmull-Rom curve at a corner between two chords as
    long as the shorter one.
    """
    turn = _corner(before, here, after)
    if turn > TURN_BACK_RAD:
        return True
    place = (here.x_m, here.y_m)
    chord = min(math.dist(place, (near.x_m, near.y_m)) for near in (before, after))
    curvature = 4.0 * math.sin(turn / 2) / (chord * math.cos(turn / 2) ** 2)
    return curvature > TIGHTEST_PER_M


def _corner(before: Waypoint, here: Waypoint, after: Waypoint) -> float:
    first = math.atan2(here.y_m - before.y_m, here.x_m - before.x_m)
    second = math.atan2(after.y_m - here.y_m, after.x_m - here.x_m)
    return abs(math.remainder(second - first, 2 * math.pi))
