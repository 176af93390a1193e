# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where on its route a robot is, followed from pose to pose."""

from bisect import bisect_right
from itertools import accumulate
import math

from husky_course.route import Route

LEG_END_M = 0.1
"""So near to the end of a leg the next begins: at a corner, or where the direction changes."""


class Progress:
    """
    Follows a robot along the legs of a route, in the frame of the course.

    The nearest place of the whole path would jump where a course crosses or comes back to itself.
    """

    def __init__(self, route: Route) -> None:
        self._legs = route.legs
        lengths_m = [leg.curve.length_m for leg in self._legs]
        self._begins_m = [0.0, *accumulate(lengths_m[:-1])]
        self.length_m = sum(lengths_m)
        self.restart()

    def restart(self) -> None:
        """Go back to where the route begins."""
        self._leg = self._sample = 0
        self._along_leg_m = 0.0
        self.offset_m = self.away_m = 0.0

    @property
    def along_m(self) -> float:
        """How far along the route the nearest place is."""
        return self._begins_m[self._leg] + self._along_leg_m

    @property
    def left_m(self) -> float:
        """Length of the path that is left."""
        return self.length_m - self.along_m

    @property
    def asked_speed_m_s(self) -> float:
        """The speed that the course asks for here, negative where it is driven backwards."""
        leg = self._legs[self._leg]
        piece = bisect_right(leg.curve.knot_s, self._along_leg_m) - 1
        speed = leg.speeds_m_s[min(piece, len(leg.speeds_m_s) - 1)]
        return -speed if leg.reverse else speed

    def follow(self, x: float, y: float) -> None:
        """Take the next pose; `offset_m` is to the left of the path, `away_m` in any direction."""
        curve = self._legs[self._leg].curve
        self._sample, self._along_leg_m, self.offset_m = curve.project(self._sample, x, y)
        if curve.length_m - self._along_leg_m <= LEG_END_M and self._leg + 1 < len(self._legs):
            self._leg, self._sample = self._leg + 1, 0
            curve = self._legs[self._leg].curve
            self._sample, self._along_leg_m, self.offset_m = curve.project(0, x, y)
        i = self._sample
        over_m = self._along_leg_m - curve.s[i]
        step_m = curve.s[i + 1] - curve.s[i]
        ahead_x, ahead_y = curve.x[i + 1] - curve.x[i], curve.y[i + 1] - curve.y[i]
        self.away_m = math.hypot(
            x - curve.x[i] - ahead_x * over_m / step_m, y - curve.y[i] - ahead_y * over_m / step_m
        )
