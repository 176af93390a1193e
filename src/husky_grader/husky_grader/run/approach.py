# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a robot of which nothing but its place is known still gets on with a course."""

from __future__ import annotations

import math

from husky_course.waypoints import Course
from husky_driver.drive import NEARER_M

VISIT_M = 1.0  # so near it was there, also where the course asks for less


class Approach:
    """
    Notices when the robot comes nearer than ever to a waypoint that it has not reached.

    Waypoints may be missed and taken in any order: whether that was right is for the score to say.
    Of several at one place a visit counts for the first, so that a way there and back, or round
    and round, has something to come nearer to until its end.
    """

    def __init__(self, course: Course) -> None:
        self._places = [(stop.x_m, stop.y_m) for stop in course.stops]
        self._left = set(range(len(self._places)))
        self._visited = set[int]()  # those the robot has not been away from since a visit
        self._least_m = [math.inf] * len(self._places)
        self._begun = False

    def is_nearer(self, place: tuple[float, float]) -> bool:
        """Take the robot's place; give it every one, in order."""
        away = [math.dist(place, stop) for stop in self._places]
        here = {k for k, distance in enumerate(away) if distance <= VISIT_M}
        if not self._begun:  # a loop does not begin with its end
            self._begun, self._visited = True, here
        self._visited &= here
        new = here & self._left - self._visited
        if new:
            self._left.discard(min(new))
            self._visited |= here
            self._least_m = away
            return True
        nearer = [k for k in self._left if away[k] < self._least_m[k] - NEARER_M]
        for k in nearer:
            self._least_m[k] = away[k]
        return bool(nearer)
