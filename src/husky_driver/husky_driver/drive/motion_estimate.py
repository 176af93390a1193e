# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Where the robot is and how it moves: odometry, corrected by the IMU. Nothing tells it the truth.

Odometry takes its heading from a gyroscope, which drifts; that of the IMU's orientation does not.
It sums up what the wheels roll, and not how the robot slides. Readings of the IMU are used when
they are LAG_SEC old, so that late delivery does not change a run; until then, and without an IMU,
the wheels count, and how the robot slides in steady motion. While the robot stands, what is felt
and what odometry turns by are errors of the sensors: for that, a drive begins with a rest.
"""

from collections import deque
import math
from typing import NamedTuple

from husky_driver.drive.heading_filter import HeadingFilter
from husky_driver.drive.kalman import Kalman
from husky_driver.drive.slip import Slip
from husky_driver.drive.velocity_filter import VelocityFilter
from husky_driver.motion import Command, ImuReading, mean_reading, Odometry

LAG_SEC = 0.1
MAX_PERIOD_SEC = 0.15  # of odometry; what is longer is a gap
SAME_SEC = 0.005  # a reading that is no later than so is of the moment of an odometry
HELD_SEC = 0.1  # where readings are lost, the last counts for so long
REST_AFTER_SEC = 0.4  # of standing: until then it sways
STEADY_RAD_S = 0.1  # least commanded turn that tells the gain, and the greatest change of it

# Standard deviations of the gain, and of a yaw rate.
_GAIN_AT_START, _GAIN_IN_A_SECOND = (0.2,), (0.01,)
_RATE_RAD_S = 0.1
_LONG = 15  # commands, in which the robot has come to turn steadily


class _Motion(NamedTuple):
    odometry: Odometry
    told_rad_s: float


class _Place(NamedTuple):
    x_m: float
    y_m: float


class MotionEstimate:
    """Give it every odometry once, in order, and the readings of the IMU."""

    def __init__(self) -> None:
        self.slip = Slip()
        self._velocity = VelocityFilter(self.slip)
        self._gain = Kalman((self.slip.yaw_gain,), _GAIN_AT_START)
        self.restart()

    def restart(self) -> None:
        """Begin a new drive, on the same ground."""
        self._heading = HeadingFilter()
        self._readings: deque[ImuReading] = deque(maxlen=1000)
        self._felt: ImuReading | None = None  # before the last odometry
        self._recent: deque[_Motion] = deque(maxlen=1000)
        self._told: deque[float] = deque(maxlen=_LONG)
        self._stood_sec = REST_AFTER_SEC  # if it stands at the start, it has stood there before
        self._settled: Odometry | None = None  # the last that readings were waited for
        self._place = _Place(0.0, 0.0)  # at that moment

    def add_reading(self, reading: ImuReading) -> None:
        """Add a sample of the IMU."""
        if all(map(math.isfinite, reading)):
            self._readings.append(reading)

    def corrected(self, odometry: Odometry, told: Command) -> Odometry:
        """
        Return the odometry with the estimated pose and speed.

        :param told: the command that the robot has followed since the odometry before.
        """
        if self._settled is None:
            self._settled = odometry
            self._place = _Place(odometry.x_m, odometry.y_m)
            self._velocity.restart(self.slip.velocity(odometry))
            return odometry
        self._recent.append(_Motion(odometry, told.yaw_rate_rad_s))
        while self._recent[0].odometry.time_sec <= odometry.time_sec - LAG_SEC:
            self._settle(self._recent.popleft())
        steady = self._steady(self._settled, odometry)
        place = self._moved(self._place, self._settled, odometry, steady)
        return odometry._replace(
            x_m=place.x_m,
            y_m=place.y_m,
            yaw_rad=math.remainder(self._yaw_rad(odometry), math.tau),
            speed_m_s=self.slip.velocity(odometry)[0],
        )

    def _settle(self, motion: _Motion) -> None:
        """Go on to an odometry, of which the reading has come if there is one."""
        before, odometry = self._settled, motion.odometry
        assert before is not None
        self._settled = odometry
        period_sec = odometry.time_sec - before.time_sec
        news = self._readings_until(odometry.time_sec)
        felt = mean_reading(news) if news else self._felt
        self._felt = felt
        if (
            felt is None
            or odometry.time_sec - felt.time_sec > HELD_SEC
            or not 0.0 < period_sec <= MAX_PERIOD_SEC
        ):
            velocity = self._steady(before, odometry)
            self._velocity.restart(self.slip.velocity(odometry))
        else:
            last = self._velocity.velocity
            at_rest = self._rests(odometry, period_sec)
            turned_rad = 0.0 if at_rest else self._heading.turned_rad(before, odometry)
            self._velocity.update(before, felt, odometry, turned_rad=turned_rad, at_rest=at_rest)
            now = self._velocity.velocity
            velocity = (last[0] + now[0]) / 2, (last[1] + now[1]) / 2
            self.slip = Slip(*self._velocity.ground, self.slip.yaw_gain)
            if news:
                self._learn_heading(news[-1], before, odometry, at_rest=at_rest)
            self._learn_gain(motion, period_sec)
        self._place = self._moved(self._place, before, odometry, velocity)

    def _readings_until(self, time_sec: float) -> list[ImuReading]:
        """Take the readings that have come since the odometry before."""
        readings, news = self._readings, []
        while readings and readings[0].time_sec <= time_sec + SAME_SEC:
            news.append(readings.popleft())
        return news

    def _rests(self, odometry: Odometry, period_sec: float) -> bool:
        """Count for how long it has stood; tell whether it sways no more."""
        self._stood_sec = self._stood_sec + period_sec if odometry.is_standing else 0.0
        return self._stood_sec > REST_AFTER_SEC

    def _learn_heading(
        self, reading: ImuReading, before: Odometry, odometry: Odometry, *, at_rest: bool
    ) -> None:
        """Learn from the last reading, as if it were of the moment of the odometry."""
        since_sec = odometry.time_sec - reading.time_sec
        yaw_rad = reading.yaw_rad + odometry.yaw_rate_rad_s * since_sec
        period_sec = odometry.time_sec - before.time_sec
        self._heading.update(period_sec, before, odometry, yaw_rad, at_rest=at_rest)

    def _steady(self, before: Odometry, odometry: Odometry) -> tuple[float, float]:
        """Return the mean velocity between two odometries, of a robot in steady motion."""
        (ahead, left), (ahead_now, left_now) = map(self.slip.velocity, (before, odometry))
        return (ahead + ahead_now) / 2, (left + left_now) / 2

    def _yaw_rad(self, odometry: Odometry) -> float:
        return odometry.yaw_rad + self._heading.error_rad(odometry.yaw_rate_rad_s)

    def _moved(
        self, place: _Place, before: Odometry, odometry: Odometry, velocity: tuple[float, float]
    ) -> _Place:
        """Go on with a velocity; through a gap, as odometry does, in the right direction."""
        period_sec = odometry.time_sec - before.time_sec
        rate = (before.yaw_rate_rad_s + odometry.yaw_rate_rad_s) / 2
        error = self._heading.error_rad(rate)
        turned = math.remainder(odometry.yaw_rad - before.yaw_rad, math.tau)
        yaw = before.yaw_rad + turned / 2 + error
        ahead, left = velocity[0] * period_sec, velocity[1] * period_sec
        dx = math.cos(yaw) * ahead - math.sin(yaw) * left
        dy = math.sin(yaw) * ahead + math.cos(yaw) * left
        if not 0.0 < period_sec <= MAX_PERIOD_SEC:  # only odometry knows what happened meanwhile
            rolled_x, rolled_y = odometry.x_m - before.x_m, odometry.y_m - before.y_m
            dx = math.cos(error) * rolled_x - math.sin(error) * rolled_y
            dy = math.sin(error) * rolled_x + math.cos(error) * rolled_y
        return _Place(place.x_m + dx, place.y_m + dy)

    def _learn_gain(self, motion: _Motion, period_sec: float) -> None:
        """Learn from the last three tenths of a second, if the command has hardly changed."""
        told, rate = self._told, motion.odometry.yaw_rate_rad_s
        told.append(motion.told_rad_s)
        least, greatest = min(told), max(told)
        if (
            len(told) == _LONG
            and least * greatest > STEADY_RAD_S**2
            and greatest - least < STEADY_RAD_S
        ):
            self._gain.grow(_GAIN_IN_A_SECOND, period_sec)
            of_late = (told[-1] + told[-2] + told[-3]) / 3
            self._gain.correct([(0, of_late)], rate, _RATE_RAD_S)
            self.slip = self.slip._replace(yaw_gain=min(max(self._gain.values[0], 0.5), 1.5))
