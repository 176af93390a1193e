# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The error of odometry's heading: that of a gyroscope, which drifts, against a magnetic one.

The two differ by a constant from the start, by what odometry has drifted since, and while the
robot turns by what odometry is late, which its filter makes it.
"""

import math

from husky_driver.drive.kalman import Kalman
from husky_driver.motion import Odometry

BETWEEN, DRIFTED, DRIFT, LATE = range(4)
_LATE_SEC = 0.0125  # of `odometry/filtered`
_AT_START = (10.0, 0.0, 0.005, 0.01)  # rad, rad, rad/s, s
_IN_A_SECOND = (0.0, 0.0003, 0.0001, 0.0)
_AT_REST_RAD_S = 0.006  # a sample of the gyroscope
_IMU_RAD = 0.008  # a sample of the IMU, of which a part is the same for some time


class HeadingFilter:
    """Estimates what has to be added to the heading of odometry, rad."""

    def __init__(self) -> None:
        self._kalman = Kalman((0.0, 0.0, 0.0, _LATE_SEC), _AT_START)

    def turned_rad(self, before: Odometry, odometry: Odometry) -> float:
        """Return by how much the robot has turned between two odometries."""
        values = self._kalman.values
        turned = math.remainder(odometry.yaw_rad - before.yaw_rad, math.tau)
        drifted = values[DRIFT] * (odometry.time_sec - before.time_sec)
        return turned + drifted + values[LATE] * (odometry.yaw_rate_rad_s - before.yaw_rate_rad_s)

    def error_rad(self, rate_rad_s: float) -> float:
        """Return the error at a yaw rate."""
        values = self._kalman.values
        return values[DRIFTED] + values[LATE] * rate_rad_s

    def update(
        self,
        period_sec: float,
        before: Odometry,
        odometry: Odometry,
        imu_rad: float,
        *,
        at_rest: bool,
    ) -> None:
        """
        Take both headings at a moment, a period after those before.

        :param at_rest: the robot does not turn: what odometry has turned by is its error.
        """
        if at_rest:
            turned_rad = math.remainder(odometry.yaw_rad - before.yaw_rad, math.tau)
            self._kalman.values[DRIFTED] -= turned_rad
            self._kalman.correct([(DRIFT, 1.0)], -turned_rad / period_sec, _AT_REST_RAD_S)
        else:
            self._drift(period_sec)
        values = self._kalman.values
        rate = odometry.yaw_rate_rad_s
        known = values[BETWEEN] + self.error_rad(rate)
        news = math.remainder(imu_rad - odometry.yaw_rad - known, math.tau)
        terms = ((BETWEEN, 1.0), (DRIFTED, 1.0), (LATE, rate))
        self._kalman.correct(terms, known + news, _IMU_RAD)

    def _drift(self, period_sec: float) -> None:
        self._kalman.values[DRIFTED] += self._kalman.values[DRIFT] * period_sec
        passing = {DRIFTED: ((DRIFTED, 1.0), (DRIFT, period_sec))}
        self._kalman.grow(_IN_A_SECOND, period_sec, passing)
