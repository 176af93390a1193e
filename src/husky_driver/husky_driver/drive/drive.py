# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Drive a course from its first waypoint to its last: odometry in, velocity commands out.

Pure: the commands are a function of the sequence of odometry alone, so that a run repeats.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
import math

from husky_course.route import DriveLimits, Leg, plan_speeds, Route
from husky_course.waypoints import Course

from husky_driver.checks.plausibility import OdometryCheck
from husky_driver.checks.watchdog import Watchdog
from husky_driver.drive.slip import SlipCorrection, SlipModel
from husky_driver.drive.time_limit import NEARER_M, TimeLimit
from husky_driver.drive.tracker import Tracker
from husky_driver.motion import Command, Odometry, STOP

ENOUGH_RAD = 0.05  # a larger heading error is turned away on the spot before a leg
ALIGNED_RAD = 0.01  # where turning on the spot ends
ALIGNED_RAD_S = 0.15
LOST_HEADING_RAD = 1.2  # facing this far from the path: stop and turn
ARRIVED_M = 0.004
SETTLE_SEC = 3.0  # a robot that does not come to rest in this time is left rolling
BLIND_STOPS = 50  # commands to stop, where what is heard of the robot cannot be believed
MAX_PERIOD_SEC = 0.1

_TWO_PI = 2 * math.pi


class Drive:
    """Follows a course; give it every odometry message once, in order."""

    def __init__(
        self, route: Route, limits: DriveLimits | None = None, *, slip: SlipModel | None = None
    ) -> None:
        """
        Prepare; the course begins at the first odometry.

        :param slip: what this odometry misses; by default that of the simulated Husky's wheels.
        """
        self._planned = self.route = route
        self._slip = SlipCorrection(slip or SlipModel())
        self.limits = limits or DriveLimits()
        self.finished = False
        self.failure = ''  # why it gave up, if it did
        self.nonsense = ''  # what it heard that cannot be true, if it did
        self.held = False  # true: stands where it is, and goes on when false again
        self.reached = 0  # waypoints, counted in order
        self._leg_index = 0
        self._tracker: Tracker | None = None
        self._now: Odometry | None = None
        self._started_sec = 0.0
        self._gave_up_sec: float | None = None
        self._check = OdometryCheck()
        self._blind_stops = 0
        self._dwelling = False
        self._limit: TimeLimit
        self._least_m = math.inf  # of the path left, so far
        self._next = 0  # the waypoint that is driven to
        self._command = STOP
        self._wishes: Iterator[Command] = iter(())

    @property
    def course(self) -> Course:
        return self.route.course

    @property
    def total(self) -> int:
        return len(self.course.stops)

    @property
    def length_m(self) -> float:
        return self.route.length_m

    @property
    def remaining_m(self) -> float:
        """Length of the path that is left, along the curve."""
        if self._tracker is None:
            return self.length_m
        later = sum(leg.curve.length_m for leg in self.route.legs[self._leg_index + 1 :])
        return self._tracker.remaining_m + later

    @property
    def tracker(self) -> Tracker | None:
        """What keeps the robot on the leg it is on; None before the first."""
        return self._tracker

    @property
    def odometry(self) -> Odometry | None:
        """What it heard last."""
        return self._now

    @property
    def speed_m_s(self) -> float:
        return 0.0 if self._now is None else self._now.speed_m_s

    @property
    def elapsed_sec(self) -> float:
        return 0.0 if self._now is None else self._now.time_sec - self._started_sec

    def summary(self) -> str:
        return f'{self.reached} of {self.total} waypoints, {self.length_m:.2f} m of path'

    def step(self, odometry: Odometry) -> Command | None:
        """Return the command that answers one odometry message; None when the drive is over."""
        if not self.nonsense and (what := self._check.complaint(odometry)):
            self.disbelieve(what)
        if self.nonsense:
            return self._stop_blindly()
        before = self._now
        if before is not None and odometry.time_sec < before.time_sec:
            self._slip.restart()  # the simulator was reset
        odometry = self._now = self._slip.corrected(odometry)
        if (before is None or odometry.time_sec < before.time_sec) and not self.failure:
            self._begin(odometry)  # the first, or the first after the simulator was reset
        if self.finished:
            return None
        if self.failure:
            return self._come_to_rest(odometry)
        self._count_reached(odometry)
        wish = self._wait() if self.held else next(self._wishes, None)
        if wish is None:
            self.finished = True
            return None
        period = 0.0 if before is None else odometry.time_sec - before.time_sec
        period = min(max(period, 0.0), MAX_PERIOD_SEC)
        self._command = self._within_limits(wish, period)
        if complaint := self._complaint(odometry):
            self.give_up(complaint)
            return STOP
        return self._command

    def _complaint(self, odometry: Odometry) -> str:
        """Return why the drive cannot go on, or nothing."""
        if complaint := self._watchdog.complaint(odometry, self._command):
            return complaint
        remaining_m = self.remaining_m
        nearer = remaining_m < self._least_m - NEARER_M
        if nearer:
            self._least_m = remaining_m
        complaint = self._limit.complaint(
            odometry.time_sec, nearer=nearer, held=self.held, dwelling=self._dwelling
        )
        if not complaint:
            return ''
        place = f'({odometry.x_m:.2f}, {odometry.y_m:.2f})'
        return f'{complaint}; it is at {place}, {remaining_m:.2f} m of path are left'

    def feel(self, time_sec: float, acceleration_m_s2: float) -> None:
        """Take what the IMU felt along the robot; a drive without it cannot feel a wall ahead."""
        if self._now is not None and not self.failure:
            self._watchdog.bump.feel(time_sec, acceleration_m_s2)

    def disbelieve(self, what: str) -> None:
        """Take notice of a message that cannot be true: nothing more is believed after it."""
        self.nonsense = self.nonsense or what
        self.give_up(what)

    def _stop_blindly(self) -> Command | None:
        """Stop a robot of which nobody knows whether it stands yet."""
        self._blind_stops += 1
        self.finished = self._blind_stops > BLIND_STOPS
        return None if self.finished else STOP

    def give_up(self, why: str) -> None:
        """Break the drive off: from now on it only stops the robot."""
        self.failure = self.failure or why

    def _come_to_rest(self, odometry: Odometry) -> Command | None:
        if self._gave_up_sec is None:
            self._gave_up_sec = odometry.time_sec
        self.finished = odometry.is_standing or odometry.time_sec - self._gave_up_sec > SETTLE_SEC
        return None if self.finished else STOP

    def _begin(self, odometry: Odometry) -> None:
        self._started_sec = odometry.time_sec
        self._command = STOP
        self._watchdog = Watchdog(odometry)
        self._next = self.reached = 0
        self.finished, self.failure, self._gave_up_sec = False, '', None
        self.route = self._route_from(odometry)
        self._leg_index, self._tracker = 0, None  # not those from before a reset
        self._least_m, self._dwelling = math.inf, False
        self._limit = TimeLimit(self.route, odometry.time_sec)
        self._wishes = self._drive()

    def _route_from(self, start: Odometry) -> Route:
        """Return the route from where the robot starts."""
        return self._planned.begun_at((start.x_m, start.y_m))

    # The course as a story: each generator yields one wished command a period and sees the
    # newest odometry in self._now when it goes on.

    def _drive(self) -> Generator[Command, None, None]:
        if not self._odometry().is_standing:  # it was driving something else
            yield from self._stand()
        for index, leg in enumerate(self.route.legs):
            self._leg_index = index
            self._tracker = tracker = self._track(leg)
            now = self._odometry()
            tracker.locate(now.x_m, now.y_m, now.yaw_rad)
            yield from self._turn(now.yaw_rad - tracker.heading_error_rad, ENOUGH_RAD)
            yield from self._follow(tracker)
            yield from self._stand()
            if leg.end_yaw_rad is not None:
                yield from self._turn(leg.end_yaw_rad, ALIGNED_RAD)
                yield from self._stand()
            yield from self._dwell(leg.dwell_sec)

    def _track(self, leg: Leg) -> Tracker:
        speeds = plan_speeds(leg.curve, leg.speeds_m_s, self.limits)
        return Tracker(leg.curve, speeds, reverse=leg.reverse, limits=self.limits)

    def _follow(self, tracker: Tracker) -> Generator[Command, None, None]:
        while True:
            now = self._odometry()
            wish = tracker.command(*now[1:])
            if tracker.remaining_m <= ARRIVED_M:
                return
            if abs(tracker.heading_error_rad) > LOST_HEADING_RAD:
                yield from self._stand()
                yield from self._turn(now.yaw_rad - tracker.heading_error_rad, ENOUGH_RAD)
            else:
                yield Command(*wish)

    def _turn(self, yaw_rad: float, enough_rad: float) -> Generator[Command, None, None]:
        """Turn on the spot to a heading, unless it is right already."""
        error = math.remainder(yaw_rad - self._odometry().yaw_rad, _TWO_PI)
        if abs(error) <= enough_rad:
            return
        while abs(error) > ALIGNED_RAD or abs(self._odometry().yaw_rate_rad_s) > ALIGNED_RAD_S:
            yield Command(0.0, self._turn_rate(error))
            error = math.remainder(yaw_rad - self._odometry().yaw_rad, _TWO_PI)

    def _stand(self) -> Generator[Command, None, None]:
        begun_sec = self._odometry().time_sec
        yield STOP
        while not (now := self._odometry()).is_standing:
            if now.time_sec - begun_sec > SETTLE_SEC:
                return
            yield STOP

    def _wait(self) -> Command:
        """Stand, and know how far the robot has rolled."""
        now = self._odometry()
        if self._tracker is not None:
            self._tracker.locate(now.x_m, now.y_m, now.yaw_rad)
        return STOP

    def _dwell(self, duration_sec: float) -> Generator[Command, None, None]:
        begun_sec, self._dwelling = self._odometry().time_sec, True
        while self._odometry().time_sec - begun_sec < duration_sec:
            yield STOP
        self._dwelling = False

    def _odometry(self) -> Odometry:
        if self._now is None:
            raise RuntimeError('no odometry yet; call step() first')
        return self._now

    def _turn_rate(self, error_rad: float) -> float:
        limits = self.limits
        braking = math.sqrt(2 * limits.turn_braking_rad_s2 * abs(error_rad))
        rate = min(limits.turn_yaw_rate_rad_s, braking, 5.0 * abs(error_rad) + 0.01)
        return math.copysign(rate, error_rad)

    def _within_limits(self, wish: Command, period_sec: float) -> Command:
        change = self.limits.acceleration_m_s2 * period_sec
        turn = self.limits.yaw_acceleration_rad_s2 * period_sec
        speed, yaw_rate = self._command
        return Command(
            min(max(wish.speed_m_s, speed - change), speed + change),
            min(max(wish.yaw_rate_rad_s, yaw_rate - turn), yaw_rate + turn),
        )

    def _count_reached(self, odometry: Odometry) -> None:
        """Count the next waypoint when it is within the tolerance; pass one left behind."""
        stops, tolerance = self.course.stops, self.course.tolerance_m
        while self._next < len(stops):
            goal = stops[self._next]
            away = math.hypot(goal.x_m - odometry.x_m, goal.y_m - odometry.y_m)
            if away <= tolerance:
                self.reached += 1
            elif not self._left_behind(self._next, tolerance):
                return
            self._next += 1

    def _left_behind(self, number: int, tolerance_m: float) -> bool:
        if self._tracker is None:
            return False
        leg = self.route.legs[self._leg_index]
        if number >= leg.last:
            return False
        if number <= leg.first:
            return True
        return self._tracker.s > leg.curve.knot_s[number - leg.first] + tolerance_m
