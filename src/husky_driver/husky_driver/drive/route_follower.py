# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Follow one route once, from its first leg to its last: one wished command a period."""

from collections.abc import Generator
import math

from husky_course.route import DriveLimits, LIMITS, Route

from husky_driver.drive.tracker import Tracker
from husky_driver.motion import Command, Odometry, STOP

ENOUGH_RAD = 0.05  # a larger heading error is turned away on the spot before a leg
ALIGNED_RAD = 0.01  # where turning on the spot ends
ALIGNED_RAD_S = 0.15
BACK_PER_SEC = 3.0  # speed over distance, while it turns on the spot
MAX_BACK_M_S = 0.4
LOST_HEADING_RAD = 1.2  # facing this far from the path: stop and turn
ARRIVED_M = 0.004
REST_SEC = 0.5  # at the start, where the sensors show their errors, see `drive.motion_estimate`
SETTLE_SEC = 3.0  # a robot that does not come to rest in this time is left rolling

_TWO_PI = 2 * math.pi


class RouteFollower:
    """Turns odometry into commands, and counts the waypoints that were reached."""

    def __init__(self, route: Route, start: Odometry, limits: DriveLimits = LIMITS) -> None:
        self.route = route
        self._limits = limits
        self.reached = 0  # waypoints, counted in order
        self.tracker: Tracker | None = None  # of the leg it is on; None before the first
        self.is_dwelling = False
        self.outward_sec2 = 0.0  # how the robot slides in bends, see `drive.slip.Slip`
        self._now = start
        self._leg_index = 0
        self._next = 0  # the waypoint that is driven to
        self._commands = self._drive()

    @property
    def remaining_m(self) -> float:
        """Length of the path that is left, along the curve."""
        if self.tracker is None:
            return self.route.length_m
        later = math.fsum(leg.curve.length_m for leg in self.route.legs[self._leg_index + 1 :])
        return self.tracker.remaining_m + later

    def command(self, odometry: Odometry, *, held: bool) -> Command | None:
        """
        Return the command for an odometry message; None at the end of the route.

        :param held: the robot has to stand; where it rolls to is still followed.
        """
        self._now = odometry
        self._count_reached()
        if not held:
            return next(self._commands, None)
        if self.tracker is not None:
            self.tracker.locate(odometry.x_m, odometry.y_m, odometry.yaw_rad)
        return STOP

    # Each generator yields one command a period. When it resumes, self._now is the newest
    # odometry.

    def _drive(self) -> Generator[Command, None, None]:
        if not self._now.is_standing:  # it was driving something else
            yield from self._stand()
        for index, leg in enumerate(self.route.legs):
            self._leg_index = index
            self.tracker = tracker = Tracker(leg, self._limits)
            now = self._now
            tracker.locate(now.x_m, now.y_m, now.yaw_rad)
            if index == 0:
                yield from self._dwell(REST_SEC)
            yield from self._turn(now.yaw_rad - tracker.heading_error_rad, ENOUGH_RAD)
            yield from self._follow(tracker)
            yield from self._stand()
            if leg.end_yaw_rad is not None:
                yield from self._turn(leg.end_yaw_rad, ALIGNED_RAD)
                yield from self._stand()
            yield from self._dwell(leg.dwell_sec)

    def _follow(self, tracker: Tracker) -> Generator[Command, None, None]:
        while True:
            now = self._now
            wish = tracker.command(*now[1:], outward_sec2=self.outward_sec2)
            if tracker.remaining_m <= ARRIVED_M:
                return
            if abs(tracker.heading_error_rad) > LOST_HEADING_RAD:
                yield from self._stand()
                yield from self._turn(now.yaw_rad - tracker.heading_error_rad, ENOUGH_RAD)
            else:
                yield Command(*wish)

    def _turn(self, yaw_rad: float, enough_rad: float) -> Generator[Command, None, None]:
        """Turn on the spot to a heading, unless it is right already."""
        spot = self._now
        error = math.remainder(yaw_rad - spot.yaw_rad, _TWO_PI)
        if abs(error) <= enough_rad:
            return
        while abs(error) > ALIGNED_RAD or abs(self._now.yaw_rate_rad_s) > ALIGNED_RAD_S:
            yield Command(self._speed_back(spot), self._turn_rate(error))
            error = math.remainder(yaw_rad - self._now.yaw_rad, _TWO_PI)

    def _speed_back(self, spot: Odometry) -> float:
        """
        Return the speed back to where a turn on the spot began.

        It creeps away meanwhile; as its heading turns, it can be brought back from any direction.
        """
        now = self._now
        ahead_m = (spot.x_m - now.x_m) * math.cos(now.yaw_rad)
        ahead_m += (spot.y_m - now.y_m) * math.sin(now.yaw_rad)
        return min(max(BACK_PER_SEC * ahead_m, -MAX_BACK_M_S), MAX_BACK_M_S)

    def _turn_rate(self, error_rad: float) -> float:
        braking = math.sqrt(2 * self._limits.turn_braking_rad_s2 * abs(error_rad))
        rate = min(self._limits.turn_yaw_rate_rad_s, braking, 6.0 * abs(error_rad) + 0.01)
        return math.copysign(rate, error_rad)

    def _stand(self) -> Generator[Command, None, None]:
        begun_sec = self._now.time_sec
        yield STOP
        while not self._now.is_standing and self._now.time_sec - begun_sec <= SETTLE_SEC:
            yield STOP

    def _dwell(self, duration_sec: float) -> Generator[Command, None, None]:
        begun_sec, self.is_dwelling = self._now.time_sec, True
        while self._now.time_sec - begun_sec < duration_sec:
            yield STOP
        self.is_dwelling = False

    def _count_reached(self) -> None:
        """Count the next waypoint within the tolerance; skip one that was missed."""
        stops, tolerance = self.route.course.stops, self.route.course.tolerance_m
        while self._next < len(stops):
            goal = stops[self._next]
            away = math.hypot(goal.x_m - self._now.x_m, goal.y_m - self._now.y_m)
            if away <= tolerance:
                self.reached += 1
            elif not self._is_missed(self._next, tolerance):
                return
            self._next += 1

    def _is_missed(self, number: int, tolerance_m: float) -> bool:
        if self.tracker is None:
            return False
        leg = self.route.legs[self._leg_index]
        if number >= leg.last:
            return False
        if number <= leg.first:
            return True
        return self.tracker.s > leg.curve.knot_s[number - leg.first] + tolerance_m
