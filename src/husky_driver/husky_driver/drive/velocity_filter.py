# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The velocity of a robot that slides, and how it slides: wheels against accelerometer.

Accelerations are summed up to a velocity, which is right for a second or two, also while the
robot sways into a turn. In the long run it has to agree with the wheels and a `Slip`, whose values
are learned by that. So do Yi, Wang, Zhang, Song, Jayasuriya and Liu: "Kinematic modeling and
analysis of skid-steered mobile robots with applications to low-cost inertial-measurement-unit-
based motion estimation", IEEE Transactions on Robotics 25, 2009.
"""

import math

from husky_driver.drive.kalman import Kalman
from husky_driver.drive.slip import Slip
from husky_driver.motion import ImuReading, Odometry

AHEAD, LEFT, ADDED_AHEAD, ADDED_LEFT, PIVOT, ONWARD, OUTWARD, ASIDE = range(8)

# Standard deviations, in the order of the states: m/s, m/s2 by the IMU, and as in Slip.
_AT_START = (0.02, 0.02, 0.01, 0.01, 0.1, 0.02, 0.07, 0.05)
_IN_A_SECOND = (0.003, 0.003, 0.0003, 0.0003, 0.003, 0.001, 0.003, 0.001)
_STEADY_M_S = 0.01  # how far the truth is from wheels and `Slip`
_SWAY_SEC = 0.2  # and how much more for each m/s2 and rad/s2 of the last moments
_MOMENT_SEC = 0.1


class VelocityFilter:
    """Estimates the speeds forwards and to the left, m/s."""

    def __init__(self, slip: Slip) -> None:
        self._kalman = Kalman((0.0, 0.0, 0.0, 0.0, *slip.ground), _AT_START)
        self._smooth = 0.0, 0.0  # the speed of the wheels and the yaw rate of a moment ago
        self._sway = 0.0  # how fast they change, m/s2 and rad/s2

    @property
    def velocity(self) -> tuple[float, float]:
        return self._kalman.values[AHEAD], self._kalman.values[LEFT]

    @property
    def ground(self) -> tuple[float, float, float, float]:
        """The values of a `Slip` that were learned."""
        pivot, onward, outward, aside = self._kalman.values[PIVOT:]
        return pivot, onward, outward, aside

    def restart(self, velocity: tuple[float, float]) -> None:
        """Go on from a velocity that is known otherwise; what was learned stays."""
        for i, speed in zip((AHEAD, LEFT), velocity, strict=True):
            self._kalman.know(i, speed, _AT_START[i])

    def update(self, before: Odometry, reading: ImuReading, odometry: Odometry) -> None:
        """Take a reading, the mean of what was felt since the odometry before."""
        period_sec = odometry.time_sec - before.time_sec
        mean_rad_s = (before.yaw_rate_rad_s + odometry.yaw_rate_rad_s) / 2
        self._predict(period_sec, mean_rad_s, reading)
        kalman, wheels, rate = self._kalman, odometry.speed_m_s, odometry.yaw_rate_rad_s
        deviation = self._deviation_m_s(odometry, period_sec)
        along = ((AHEAD, 1.0), (PIVOT, -rate), (ONWARD, -wheels * abs(rate)))
        kalman.correct(along, wheels, deviation)
        ahead, bend = kalman.values[AHEAD], rate * abs(rate)
        # left + outward * ahead * bend + aside * rate * rate = 0, near the values of now
        outward = kalman.values[OUTWARD]
        across = (
            *((AHEAD, outward * bend), (LEFT, 1.0)),
            *((OUTWARD, ahead * bend), (ASIDE, rate * rate)),
        )
        kalman.correct(across, outward * ahead * bend, deviation)

    def _deviation_m_s(self, odometry: Odometry, period_sec: float) -> float:
        """Return how far the truth may be from the wheels: more while speed and turn change."""
        speed, rate = self._smooth
        change = odometry.speed_m_s - speed, odometry.yaw_rate_rad_s - rate
        share = min(period_sec / _MOMENT_SEC, 1.0)
        self._smooth = speed + share * change[0], rate + share * change[1]
        kept = self._sway * (1.0 - share / 2.0)
        self._sway = max((abs(change[0]) + abs(change[1])) / _MOMENT_SEC, kept)
        return _STEADY_M_S + _SWAY_SEC * self._sway

    def _predict(self, period_sec: float, rate: float, reading: ImuReading) -> None:
        values = self._kalman.values
        ahead, left, added_ahead, added_left = values[:4]
        # Into the axes of now, in which the reading is; in those of before, a bend would brake.
        cos, sin = math.cos(rate * period_sec), math.sin(rate * period_sec)
        gained_ahead = (reading.forward_m_s2 - added_ahead) * period_sec
        gained_left = (reading.left_m_s2 - added_left) * period_sec
        values[AHEAD] = cos * ahead + sin * left + gained_ahead
        values[LEFT] = cos * left - sin * ahead + gained_left
        passing = {
            AHEAD: ((AHEAD, cos), (LEFT, sin), (ADDED_AHEAD, -period_sec)),
            LEFT: ((AHEAD, -sin), (LEFT, cos), (ADDED_LEFT, -period_sec)),
        }
        self._kalman.grow(_IN_A_SECOND, period_sec, passing)
