# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A course planned once: its legs, its path as one curve, and the time it takes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
import math

from husky_course.route.legs import lead_in, Leg, legs_of
from husky_course.route.path import Curve, joined, Point
from husky_course.route.speeds import plan_speeds
from husky_course.waypoints import Course

STOP_ALLOWANCE_SEC = 1.0  # for each stop on the way, beside the turning
TURN_ALLOWANCE_RAD_S = 1.0
LIMIT_FACTOR, LIMIT_EXTRA_SEC = 3.0, 20.0  # of the time that the course takes


@dataclass(frozen=True)
class Route:
    """The legs of a course in the order of driving, in the frame odom."""

    course: Course
    legs: tuple[Leg, ...]

    @cached_property
    def curve(self) -> Curve:
        """The whole path."""
        return joined([leg.curve for leg in self.legs])

    @cached_property
    def length_m(self) -> float:
        """Length of the path."""
        return math.fsum(leg.curve.length_m for leg in self.legs)

    @cached_property
    def par_time_sec(self) -> float:
        """Time the course takes at the asked speed, with allowances for its stops."""
        seconds, heading = 0.0, 0.0
        for leg in self.legs:
            seconds += _asked_sec(leg) + STOP_ALLOWANCE_SEC + leg.dwell_sec
            seconds += _turn_sec(heading, leg.begin_yaw_rad)
            heading = leg.arrival_yaw_rad
            if leg.end_yaw_rad is not None:
                seconds += _turn_sec(heading, leg.end_yaw_rad)
                heading = leg.end_yaw_rad
        return seconds

    @cached_property
    def limit_sec(self) -> float:
        """How long it may take: three times what it needs, bends included, and 20 s."""
        slowed = math.fsum(_slowed_sec(leg) for leg in self.legs)
        return LIMIT_FACTOR * (self.par_time_sec + slowed) + LIMIT_EXTRA_SEC

    def begun_at(self, place: Point) -> Route:
        """Return the route with the straight way from a place to its first waypoint."""
        way = lead_in(self.course, place)
        return self if way is None else replace(self, legs=(way, *self.legs))


def plan_route(course: Course) -> Route:
    """Return the route from the first waypoint to the last."""
    return Route(course, legs_of(course))


def _turn_sec(begin_rad: float, end_rad: float) -> float:
    return abs(math.remainder(end_rad - begin_rad, 2 * math.pi)) / TURN_ALLOWANCE_RAD_S


def _asked_sec(leg: Leg) -> float:
    knots = leg.curve.knot_s
    return math.fsum((knots[i + 1] - knots[i]) / speed for i, speed in enumerate(leg.speeds_m_s))


def _slowed_sec(leg: Leg) -> float:
    """Return how much longer a leg takes than at the asked speed, for its bends and its end."""
    s = leg.curve.s
    speeds = plan_speeds(leg.curve, leg.speeds_m_s)
    planned = math.fsum(
        2.0 * (s[i + 1] - s[i]) / (speeds[i] + speeds[i + 1]) for i in range(len(s) - 1)
    )
    return max(planned - _asked_sec(leg), 0.0)
