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
_IN_A_SECOND = (0.001, 0.001, 0.0003, 0.0003, 0.005, 0.001, 0.005, 0.001)
# How far the truth is from wheels and `Slip`, m/s: the faster it turns, the further; beyond
# 0.7 rad/s a `Slip` is only nearly right. While speed and turn change, wheels may spin.
_STRAIGHT_M_S = 0.002
_TURNING = 0.01, 0.02  # times the yaw rate, times its square
_SWAYING = 0.02, 0.05  # the same with how fast speed and yaw rate have changed
_MOMENT_SEC = 0.1  # in which
_RESTING_M_S = 0.001  # how far from zero it is at rest, where a reading is the sensor's own error


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

    def update(
        self,
        before: Odometry,
        reading: ImuReading,
        odometry: Odometry,
        *,
        turned_rad: float,
        at_rest: bool,
    ) -> None:
        """
        Take a reading, the mean of what was felt since the odometry before.

        :param turned_rad: by how much the robot has turned since then.
        :param at_rest: the robot does not move: what is felt is the accelerometer's error.
        """
        period_sec = odometry.time_sec - before.time_sec
        self._predict(period_sec, turned_rad, reading)
        if at_rest:
            for i in (AHEAD, LEFT):
                self._kalman.correct([(i, 1.0)], 0.0, _RESTING_M_S)
        else:
            self._agree(odometry, self._deviation_m_s(odometry, period_sec))

    def _agree(self, odometry: Odometry, deviation_m_s: float) -> None:
        """Agree with the wheels and the `Slip` that is learned so."""
        kalman, wheels, rate = self._kalman, odometry.speed_m_s, odometry.yaw_rate_rad_s
        along = ((AHEAD, 1.0), (PIVOT, -rate), (ONWARD, -wheels * abs(rate)))
        kalman.correct(along, wheels, deviation_m_s)
        ahead, bend = kalman.values[AHEAD], rate * abs(rate)
        # left + outward * ahead * bend + aside * rate * rate = 0, near the values of now
        outward = kalman.values[OUTWARD]
        across = (
            *((AHEAD, outward * bend), (LEFT, 1.0)),
            *((OUTWARD, ahead * bend), (ASIDE, rate * rate)),
        )
        kalman.correct(across, outward * ahead * bend, deviation_m_s)

    def _deviation_m_s(self, odometry: Odometry, period_sec: float) -> float:
        """Return how far the truth may be from the wheels: more while speed and turn change."""
        speed, rate = self._smooth
        change = odometry.speed_m_s - speed, odometry.yaw_rate_rad_s - rate
        share = min(period_sec / _MOMENT_SEC, 1.0)
        self._smooth = speed + share * change[0], rate + share * change[1]
        kept = self._sway * (1.0 - share / 2.0)
        self._sway = max((abs(change[0]) + abs(change[1])) / _MOMENT_SEC, kept)
        turn, sway = abs(odometry.yaw_rate_rad_s), self._sway
        turning = _TURNING[0] * turn + _TURNING[1] * turn * turn
        return _STRAIGHT_M_S + turning + _SWAYING[0] * sway + _SWAYING[1] * sway * sway

    def _predict(self, period_sec: float, turned_rad: float, reading: ImuReading) -> None:
        values = self._kalman.values
        ahead, left, added_ahead, added_left = values[:4]
        # Into the axes of now, in which the reading is; in those of before, a bend would brake.
        cos, sin = math.cos(turned_rad), math.sin(turned_rad)
        gained_ahead = (reading.forward_m_s2 - added_ahead) * period_sec
        gained_left = (reading.left_m_s2 - added_left) * period_sec
        values[AHEAD] = cos * ahead + sin * left + gained_ahead
        values[LEFT] = cos * left - sin * ahead + gained_left
        passing = {
            AHEAD: ((AHEAD, cos), (LEFT, sin), (ADDED_AHEAD, -period_sec)),
            LEFT: ((AHEAD, -sin), (LEFT, cos), (ADDED_LEFT, -period_sec)),
        }
        self._kalman.grow(_IN_A_SECOND, period_sec, passing)
