# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Drive a course from its first waypoint to its last: odometry in, velocity commands out.

Pure: the commands are a function of the sequence of odometry alone, so that a run repeats.
"""

from functools import partial
import math

from husky_course.frames import Pose, to_world
from husky_course.route import DriveLimits, LIMITS, plan_route, Route
from husky_course.waypoints import Course, Waypoint

from husky_driver.checks.plausibility import OdometryCheck
from husky_driver.checks.watchdog import Watchdog
from husky_driver.drive.motion_estimate import MotionEstimate
from husky_driver.drive.route_follower import RouteFollower, SETTLE_SEC
from husky_driver.drive.time_limit import NEARER_M, TimeLimit
from husky_driver.drive.tracker import Tracker
from husky_driver.motion import AT_ORIGIN, Command, ImuReading, Odometry, STOP

UNTRUSTED_STOPS = 50  # commands to stop a robot whose odometry cannot be true
MAX_PERIOD_SEC = 0.1
AT_REST_SEC = 0.5
"""Of one that gave up: between rolling forth and back it stands for a moment, too."""


class Drive:
    """Follows a course; give it every odometry message once, in order."""

    def __init__(
        self,
        route: Route,
        *,
        slip: bool = True,
        limits: DriveLimits = LIMITS,
        before: 'Drive | None' = None,
    ) -> None:
        """
        Prepare; the course begins at the first odometry.

        :param slip: count with what odometry misses; false where it misses nothing.
        :param limits: of the robot.
        :param before: the drive that this one goes on from, on the same ground.
        """
        self._planned = route
        self.limits = limits
        known = before._estimate if before else None
        self._estimate: MotionEstimate | None = (known or MotionEstimate()) if slip else None
        self.finished = False
        self.failure = ''  # why it gave up, if it did
        self.implausible = ''  # why a message cannot be true, if one could not
        self._command = STOP
        self.held = False  # true: stands where it is, and goes on when false again
        # The last odometry that was plausible, corrected for slip; None before the first.
        self.odometry: Odometry | None = None
        self._gave_up_sec: float | None = None
        self._moved_sec = 0.0  # when it moved last, after it gave up
        self._check = OdometryCheck()
        self._untrusted_stops = 0
        self._begin(route, AT_ORIGIN)

    def _begin(self, route: Route, odometry: Odometry) -> None:
        self._started_sec = odometry.time_sec
        self._command = STOP
        self._follower = RouteFollower(route, odometry, self.limits)
        self._watchdog = Watchdog(odometry)
        self._limit = TimeLimit(route, odometry.time_sec)
        self._least_m = math.inf  # of the path left, so far

    @property
    def route(self) -> Route:
        """The route from where the robot has started."""
        return self._follower.route

    @property
    def course(self) -> Course:
        return self.route.course

    @property
    def reached(self) -> int:
        """How many waypoints were reached, counted in order."""
        return self._follower.reached

    @property
    def total(self) -> int:
        return len(self.course.stops)

    @property
    def length_m(self) -> float:
        return self.route.length_m

    @property
    def remaining_m(self) -> float:
        """Length of the path that is left, along the curve."""
        return self._follower.remaining_m

    @property
    def tracker(self) -> Tracker | None:
        """The tracker of the leg it is on; None before the first."""
        return self._follower.tracker

    @property
    def speed_m_s(self) -> float:
        return 0.0 if self.odometry is None else self.odometry.speed_m_s

    @property
    def elapsed_sec(self) -> float:
        return 0.0 if self.odometry is None else self.odometry.time_sec - self._started_sec

    def summary(self) -> str:
        return f'{self.reached} of {self.total} waypoints, {self.length_m:.2f} m of path'

    def step(self, odometry: Odometry) -> Command | None:
        """Return the command that answers one odometry message; None when the drive is over."""
        if not self.implausible and (what := self._check.complaint(odometry)):
            self.refuse_odometry(what)
        if self.implausible:
            return self._stop_untrusted()
        before = self.odometry
        was_reset = before is not None and odometry.time_sec < before.time_sec
        odometry = self.odometry = self._corrected(odometry, was_reset=was_reset)
        if (before is None or was_reset) and not self.failure:
            self.finished = False
            self._begin(self._route_from(odometry), odometry)
        if self.finished:
            return None
        if self.failure:
            return self._come_to_rest(odometry)
        if self._estimate is not None:
            self._follower.outward_sec2 = self._estimate.slip.outward_sec2
        wish = self._follower.command(odometry, held=self.held)
        if wish is None:
            self.finished = True
            return None
        period = 0.0 if before is None else odometry.time_sec - before.time_sec
        period = min(max(period, 0.0), MAX_PERIOD_SEC)
        self._command = self._within_limits(self._slipping(wish), period)
        if complaint := self._complaint(odometry):
            self.give_up(complaint)
            return STOP
        return self._command

    def _corrected(self, odometry: Odometry, *, was_reset: bool) -> Odometry:
        if self._estimate is None:
            return odometry
        if was_reset:
            self._estimate.restart()
        return self._estimate.corrected(odometry, self._command)

    def _slipping(self, wish: Command) -> Command:
        """Return the command by which a robot that slips does what is wished."""
        return wish if self._estimate is None else self._estimate.slip.command(wish, self.limits)

    def _route_from(self, start: Odometry) -> Route:
        """Return the route from where the robot starts."""
        return self._planned.begun_at((start.x_m, start.y_m))

    def _complaint(self, odometry: Odometry) -> str:
        """Return why the drive cannot go on, or nothing."""
        if complaint := self._watchdog.complaint(odometry, self._command):
            return complaint
        remaining_m = self.remaining_m
        nearer = remaining_m < self._least_m - NEARER_M
        if nearer:
            self._least_m = remaining_m
        complaint = self._limit.complaint(
            odometry.time_sec, nearer=nearer, held=self.held, dwelling=self._follower.is_dwelling
        )
        if not complaint:
            return ''
        place = f'({odometry.x_m:.2f}, {odometry.y_m:.2f})'
        return f'{complaint}; it is at {place}, {remaining_m:.2f} m of path are left'

    def add_imu(self, reading: ImuReading) -> None:
        """Add a sample of the IMU; without any, slip is not learned and a wall not detected."""
        if self.odometry is not None and not self.failure:
            self._watchdog.bump.add_acceleration(reading.time_sec, reading.forward_m_s2)
            if self._estimate is not None:
                self._estimate.add_reading(reading)

    def refuse_odometry(self, what: str) -> None:
        """Give up because a message cannot be true; no odometry is used after it."""
        self.implausible = self.implausible or what
        self.give_up(what)

    def _stop_untrusted(self) -> Command | None:
        """Stop a robot without using its odometry, for a fixed number of commands."""
        self._untrusted_stops += 1
        self.finished = self._untrusted_stops > UNTRUSTED_STOPS
        return None if self.finished else STOP

    def give_up(self, why: str) -> None:
        """Break the drive off: from now on it only stops the robot."""
        self.failure = self.failure or why

    def _come_to_rest(self, odometry: Odometry) -> Command | None:
        now = odometry.time_sec
        if self._gave_up_sec is None or now < self._gave_up_sec:  # the simulation was reset
            self._gave_up_sec = self._moved_sec = now
        if not odometry.is_standing:
            self._moved_sec = now
        self.finished = (
            now - self._moved_sec >= AT_REST_SEC or now - self._gave_up_sec > SETTLE_SEC
        )
        return None if self.finished else STOP

    def _within_limits(self, wish: Command, period_sec: float) -> Command:
        change = self.limits.acceleration_m_s2 * period_sec
        turn = self.limits.yaw_acceleration_rad_s2 * period_sec
        speed, yaw_rate = self._command
        return Command(
            min(max(wish.speed_m_s, speed - change), speed + change),
            min(max(wish.yaw_rate_rad_s, yaw_rate - turn), yaw_rate + turn),
        )


class DistanceDrive(Drive):
    """Drives straight on or back from where the robot starts, as the lab sheet's questions ask."""

    def __init__(
        self,
        speed_m_s: float,
        distance_m: float,
        *,
        forward: bool = True,
        limits: DriveLimits = LIMITS,
    ) -> None:
        plan = partial(_straight_route, speed_m_s, distance_m if forward else -distance_m)
        super().__init__(plan((0.0, 0.0, 0.0)), limits=limits)
        self._plan = plan

    def _route_from(self, start: Odometry) -> Route:
        return self._plan((start.x_m, start.y_m, start.yaw_rad))


def _straight_route(speed_m_s: float, ahead_m: float, start: Pose) -> Route:
    begin = Waypoint(start[0], start[1])
    goal = Waypoint(*to_world(start, ahead_m, 0.0), reverse=ahead_m < 0.0)
    return plan_route(Course('distance', (begin, goal), speed_m_s=speed_m_s))
