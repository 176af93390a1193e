# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Decide when the run of somebody's controller is over; times are simulated ones."""

import math

from husky_course.route import Point, Route
from husky_course.waypoints import Course
from husky_driver.drive import NEARER_M, TimeLimit

START_WITHIN_SEC = 10.0  # from when time began to pass: before, it was waited for
REST_SEC = 8.0  # a robot that stands so long is not going on (beside a dwell of the course), ...
REST_AT_END_SEC = 2.0  # ... or so long at the end of the course, ...
REST_ALONE_SEC = 1.0  # ... or when the controller has ended
STANDING_M_S = 0.02
STANDING_RAD_S = 0.05
VISIT_M = 1.0  # so near it was there, also where the course asks for less


class Referee:
    """Watches the true pose, in the frame the robot started in."""

    def __init__(self, route: Route, *, start_within_sec: float = START_WITHIN_SEC) -> None:
        self._start_within_sec = start_within_sec
        course = route.course
        self._goal = course.stops[-1]
        self._tolerance_m = course.tolerance_m
        self._half_m = route.length_m / 2
        self._limit = TimeLimit(route.begun_at((0.0, 0.0)), 0.0)
        self._progress = _Progress(course)
        self._dwells = [stop for stop in course.stops[:-1] if stop.dwell_sec > 0.0]
        self._heard_sec: float | None = None
        self._now_sec = 0.0  # from the first pose on; a reset takes nothing back
        self.started = False  # whether the robot has moved
        self._resting_since_sec = 0.0
        self._driven_m = 0.0
        self._last = (0.0, 0.0)

    def over(
        self,
        time_sec: float,
        place: Point,
        *,
        speed_m_s: float,
        yaw_rate_rad_s: float,
        running: bool,
    ) -> str:
        """Return why the run is over, or nothing; `running` tells of the controller's process."""
        if self._heard_sec is None:
            self._heard_sec, self._last = time_sec, place
        self._now_sec += max(time_sec - self._heard_sec, 0.0)
        self._heard_sec = time_sec
        self._driven_m += math.dist(place, self._last)
        self._last = place
        moving = abs(speed_m_s) > STANDING_M_S or abs(yaw_rate_rad_s) > STANDING_RAD_S
        if moving or not self.started:
            self._resting_since_sec = self._now_sec
        self.started = self.started or moving
        nearer = self._progress.is_nearer(place)
        if not self.started:
            self._limit.complaint(self._now_sec, nearer=nearer, held=True)
            return self._before_start(self._now_sec, running=running)
        return self._at_rest(place, running=running) or self._limit.complaint(
            self._now_sec, nearer=nearer, dwelling=self._dwell_sec(place) > self._rest_sec
        )

    @property
    def waypoints_left(self) -> int:
        """How many waypoints the robot has not been at, in whatever order, beside the first."""
        return self._progress.left

    @property
    def _rest_sec(self) -> float:
        return self._now_sec - self._resting_since_sec

    def _at_rest(self, place: Point, *, running: bool) -> str:
        """Return why a robot that stands will not go on; one that is to dwell may stand long."""
        rest_sec, dwell_sec = self._rest_sec, self._dwell_sec(place)
        if not running and rest_sec > REST_ALONE_SEC:
            return 'the controller has ended'
        if rest_sec > REST_AT_END_SEC + dwell_sec and self._at_end(place):
            return 'it stands at the end of the course'
        allowed_sec = REST_SEC + dwell_sec
        return f'it stood still for {allowed_sec:.0f} s' if rest_sec > allowed_sec else ''

    def _dwell_sec(self, place: Point) -> float:
        """Return for how long the course lets it stand here."""
        near = (
            stop.dwell_sec
            for stop in self._dwells
            if math.dist(place, (stop.x_m, stop.y_m)) <= self._tolerance_m
        )
        return max(near, default=0.0)

    def _before_start(self, waited_sec: float, *, running: bool) -> str:
        if not running and waited_sec > REST_ALONE_SEC:
            return 'the controller has ended'
        if waited_sec > self._start_within_sec:
            return f'nothing moved for {self._start_within_sec:.0f} s'
        return ''

    def _at_end(self, place: Point) -> bool:
        away = math.dist(place, (self._goal.x_m, self._goal.y_m))
        if self._driven_m <= self._half_m or away > self._tolerance_m:
            return False
        return not self._progress.leads_away(place)  # the path may pass its end before


class _Progress:
    """
    Notices when the robot comes nearer than ever to a waypoint that it has not reached.

    Waypoints may be missed and taken in any order: whether that was right is for the score to say.
    Of several at one place a visit counts for the first, so that a way there and back, or round
    and round, has something to come nearer to until its end. Laps so small that the robot is
    never away from a waypoint count by those that it reaches in their order.
    """

    def __init__(self, course: Course) -> None:
        self._places = [(stop.x_m, stop.y_m) for stop in course.stops]
        self._left = set(range(len(self._places)))
        self._visited = set[int]()  # those the robot has not been away from since a visit
        self._least_m = [math.inf] * len(self._places)
        self._tolerance_m = course.tolerance_m
        self._reached = 0  # how many in their order, each as near as the course asks for
        self._furthest = 0
        self._begun = False

    @property
    def left(self) -> int:
        """How many waypoints are left, beside the first, where the robot starts."""
        return len(self._left - {0})

    def leads_away(self, place: Point) -> bool:
        """Tell whether of the waypoints behind all that were visited one is left elsewhere."""
        later = (self._places[k] for k in self._left if k > self._furthest)
        return any(math.dist(place, each) > VISIT_M for each in later)

    def is_nearer(self, place: Point) -> bool:
        """Take the robot's place; give it every one, in order."""
        away = [math.dist(place, stop) for stop in self._places]
        here = {k for k, distance in enumerate(away) if distance <= VISIT_M}
        if not self._begun:  # a loop does not begin with its end
            self._begun, self._visited = True, here
        self._visited &= here
        new = here & self._left - self._visited
        if new:
            self._pass(min(new))
            self._visited |= here
        is_next = self._reached < len(away) and away[self._reached] <= self._tolerance_m
        if is_next:
            self._pass(self._reached)
            self._reached += 1
        if new or is_next:
            self._least_m = away
            return True
        nearer = [k for k in self._left if away[k] < self._least_m[k] - NEARER_M]
        for k in nearer:
            self._least_m[k] = away[k]
        return bool(nearer)

    def _pass(self, waypoint: int) -> None:
        self._left.discard(waypoint)
        self._furthest = max(self._furthest, waypoint)
