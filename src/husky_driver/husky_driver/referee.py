# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Decide when the run of somebody's controller is over; times are simulated ones."""

from __future__ import annotations

import math

from husky_driver.route import plan_route
from husky_driver.scoring import par_time_sec
from husky_driver.waypoints import Course

START_WITHIN_SEC = 20.0  # from when its process started
REST_SEC = 8.0  # a robot that stands so long is not going on, ...
REST_AT_END_SEC = 2.0  # ... or so long at the end of the course, ...
REST_ALONE_SEC = 1.0  # ... or when the controller has ended
TIME_FACTOR, TIME_EXTRA_SEC = 3.0, 20.0  # of the time at the asked speed
STANDING_M_S = 0.02
STANDING_RAD_S = 0.05
MOVED_M = 0.05


class Referee:
    """Watches the true pose, in the frame the robot started in."""

    def __init__(self, course: Course, *, start_within_sec: float = START_WITHIN_SEC) -> None:
        self._start_within_sec = start_within_sec
        legs = plan_route(course)
        self._goal = course.stops[-1]
        self._tolerance_m = course.tolerance_m
        self._half_m = sum(leg.curve.length_m for leg in legs) / 2
        self._limit_sec = TIME_FACTOR * par_time_sec(legs) + TIME_EXTRA_SEC
        self._begun_sec: float | None = None
        self._started_sec: float | None = None
        self._resting_since_sec = 0.0
        self._driven_m = 0.0
        self._last = (0.0, 0.0)

    @property
    def started(self) -> bool:
        """Tell whether the robot has moved."""
        return self._started_sec is not None

    def over(
        self,
        time_sec: float,
        place: tuple[float, float],
        *,
        speed_m_s: float,
        yaw_rate_rad_s: float,
        running: bool,
    ) -> str:
        """Return why the run is over, or nothing; `running` tells of the controller's process."""
        if self._begun_sec is None:
            self._begun_sec, self._last = time_sec, place
        self._driven_m += math.dist(place, self._last)
        self._last = place
        moving = abs(speed_m_s) > STANDING_M_S or abs(yaw_rate_rad_s) > STANDING_RAD_S
        if moving or self._started_sec is None:
            self._resting_since_sec = time_sec
        if self._started_sec is None:
            if not moving:
                return self._before_start(time_sec - self._begun_sec, running=running)
            self._started_sec = time_sec
        if time_sec - self._started_sec > self._limit_sec:
            return f'time is up after {self._limit_sec:.0f} s'
        rest = time_sec - self._resting_since_sec
        if not running and rest > REST_ALONE_SEC:
            return 'the controller has ended'
        if rest > REST_AT_END_SEC and self._at_end(place):
            return 'it stands at the end of the course'
        return f'it stood still for {REST_SEC:.0f} s' if rest > REST_SEC else ''

    def _before_start(self, waited_sec: float, *, running: bool) -> str:
        if not running and waited_sec > REST_ALONE_SEC:
            return 'the controller has ended'
        if waited_sec > self._start_within_sec:
            return f'nothing moved for {self._start_within_sec:.0f} s'
        return ''

    def _at_end(self, place: tuple[float, float]) -> bool:
        away = math.dist(place, (self._goal.x_m, self._goal.y_m))
        return self._driven_m > self._half_m and away <= self._tolerance_m
