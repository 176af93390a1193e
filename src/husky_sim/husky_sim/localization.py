# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Where the robot thinks it is: an extended Kalman filter of wheel odometry and IMU, in the plane.

It is the planar part (two_d_mode) of what robot_localization does with the Husky's
localization.yaml: from the wheels vx, vy and the yaw rate, from the IMU the yaw, differentially,
and the yaw rate. Process noise of the speeds and the initial covariance are the defaults of that
package, which the Husky does not change. Its defaults for the pose are for any robot at all, and
would put 10 m of uncertainty behind a minute of driving. Ours are what wheels that slip (0.15 m a
minute) and a gyroscope that drifts (0.3 rad a minute) make of it here.
"""

import math

import numpy as np
import numpy.typing as npt

from husky_sim.diff_drive import wrapped
from husky_sim.imu import VARIANCE as IMU_VARIANCE

Array = npt.NDArray[np.float64]

X, Y, YAW, VX, VY, RATE, AX, AY = range(8)

# A second of process noise, in the order of the states.
PROCESS_NOISE = (0.0004, 0.0004, 0.0015, 0.025, 0.025, 0.02, 0.01, 0.01)
INITIAL_VARIANCE = 1e-9

WHEEL_SPEED_VARIANCE = 0.001
WHEEL_RATE_VARIANCE = 0.03


class PlanarFilter:
    """
    Estimates x, y and yaw in the frame `odom`, and the speeds in base_link.

    Bit for bit the same for the same measurements.
    """

    def __init__(self, period_sec: float) -> None:
        self._period_sec = period_sec
        self._noise = np.diag(PROCESS_NOISE) * period_sec
        # Three measurements of one rate are as good as one that is weighed from them. A
        # difference of two headings has the variance of both.
        variances = (WHEEL_RATE_VARIANCE, IMU_VARIANCE, 2.0 * IMU_VARIANCE / period_sec**2)
        self._rate_variance = 1.0 / sum(1.0 / variance for variance in variances)
        self._weights = [self._rate_variance / variance for variance in variances]
        self._jacobian = np.eye(8)
        for row, column in ((YAW, RATE), (VX, AX), (VY, AY)):
            self._jacobian[row, column] = period_sec
        self.reset()

    def reset(self, imu_yaw: float = 0.0) -> None:
        """Start again at the origin, heading along x whatever the IMU says."""
        self._state = np.zeros(8)
        self.covariance: Array = np.eye(8) * INITIAL_VARIANCE
        self._imu_yaw = imu_yaw
        self._read_out()

    def update(
        self,
        *,
        wheel_speed_m_s: float,
        wheel_yaw_rate_rad_s: float,
        imu_yaw: float,
        imu_yaw_rate_rad_s: float,
    ) -> None:
        """Take the measurements at the end of a control period."""
        turned_rad_s = wrapped(imu_yaw - self._imu_yaw) / self._period_sec
        self._imu_yaw = imu_yaw
        rates = (wheel_yaw_rate_rad_s, imu_yaw_rate_rad_s, turned_rad_s)
        rate = sum(w * each for w, each in zip(self._weights, rates, strict=True))
        self._predict()
        self._correct(VX, wheel_speed_m_s, WHEEL_SPEED_VARIANCE)
        self._correct(VY, 0.0, WHEEL_SPEED_VARIANCE)
        self._correct(RATE, rate, self._rate_variance)
        self._read_out()

    def _predict(self) -> None:
        t = self._period_sec
        _, _, yaw, vx, vy, rate, ax, ay = self._state.tolist()
        cos, sin = math.cos(yaw), math.sin(yaw)
        forward, left = vx * t + ax * t * t / 2.0, vy * t + ay * t * t / 2.0
        self._state += (
            forward * cos - left * sin,
            forward * sin + left * cos,
            rate * t,
            ax * t,
            ay * t,
            0.0,
            0.0,
            0.0,
        )
        half = t * t / 2.0
        self._jacobian[X, 2:] = (
            -forward * sin - left * cos, t * cos, -t * sin, 0.0, half * cos, -half * sin
        )  # fmt: skip
        self._jacobian[Y, 2:] = (
            forward * cos - left * sin, t * sin, t * cos, 0.0, half * sin, half * cos
        )  # fmt: skip
        self.covariance = self._jacobian @ self.covariance @ self._jacobian.T + self._noise

    def _correct(self, place: int, measured: float, variance: float) -> None:
        """Take one measurement of one state."""
        column = self.covariance[:, place].copy()
        gain = column / (column[place] + variance)
        self._state += gain * (measured - self._state[place])
        self.covariance -= gain[:, None] * column

    def _read_out(self) -> None:
        self.x, self.y, yaw, self.speed_m_s, self.sideways_m_s, self.yaw_rate_rad_s, _, _ = (
            self._state.tolist()
        )
        self.yaw = wrapped(yaw)
