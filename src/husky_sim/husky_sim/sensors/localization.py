# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The estimated pose: an extended Kalman filter of wheel odometry and IMU, in the plane.

It is the planar part (two_d_mode) of what robot_localization does with the Husky's
localization.yaml: from the wheels vx, vy and the yaw rate, from the IMU the yaw, differentially,
and the yaw rate. Process noise of the speeds and the initial covariance are the defaults of that
package, which the Husky does not change. Its defaults for the pose suit any robot: after a minute
of driving their uncertainty is 10 m. The values here follow from wheels that slip (0.15 m a
minute) and a gyroscope that drifts (0.3 rad a minute).
"""

import math

from husky_course.frames import Array, wrapped
import mujoco
import numpy as np

from husky_sim.sensors.imu import VARIANCE as IMU_VARIANCE

X, Y, YAW, VX, VY, RATE, AX, AY = range(8)

# A second of process noise, in the order of the states.
PROCESS_NOISE = (0.0004, 0.0004, 0.0015, 0.025, 0.025, 0.02, 0.01, 0.01)
INITIAL_VARIANCE = 1e-9

WHEEL_SPEED_VARIANCE = 0.001
WHEEL_RATE_VARIANCE = 0.03


class PlanarFilter:
    """
    Estimates x, y and yaw in the frame `odom`, and the speeds in base_link.

    Bit for bit the same for the same measurements, on every CPU of a kind: sums and products of
    matrices are MuJoCo's, where those of numpy and LAPACK choose their code by the CPU.
    """

    def __init__(self, period_sec: float) -> None:
        self._period_sec = period_sec
        self._noise = np.diag(PROCESS_NOISE) * period_sec
        # Three measurements of one rate are worth one, weighted by their variances. A difference
        # of two headings has the variance of both.
        variances = (WHEEL_RATE_VARIANCE, IMU_VARIANCE, 2.0 * IMU_VARIANCE / period_sec**2)
        self._rate_variance = 1.0 / math.fsum(1.0 / variance for variance in variances)
        self._weights = [self._rate_variance / variance for variance in variances]
        self._jacobian = np.eye(8)
        for row, column in ((YAW, RATE), (VX, AX), (VY, AY)):
            self._jacobian[row, column] = period_sec
        self.covariance: Array = np.empty((8, 8))
        self._seen = self.covariance[VX : RATE + 1]
        self._seen_variances = self._seen[:, VX : RATE + 1]
        self._inverse, self._size, self._errors = np.empty((3, 3)), np.empty(()), np.empty(3)
        self._product, self._gains, self._change = np.empty((8, 8)), np.empty((3, 8)), np.empty(8)
        # Numbers are read and written through these: in a row of an array it takes five times as
        # long. Of the covariance, from x or from VX on, eight a row.
        self._jacobian_numbers = _numbers(self._jacobian)
        self._inverse_numbers = _numbers(self._inverse)
        self._error_numbers = _numbers(self._errors)
        self.pose_covariance = _numbers(self.covariance)
        self.twist_covariance = self.pose_covariance[8 * VX + VX :]
        self.reset()

    def reset(self, imu_yaw: float = 0.0) -> None:
        """Start again at the origin, heading along x whatever the IMU says."""
        self._state = [0.0] * 8
        self.covariance[:] = np.eye(8) * INITIAL_VARIANCE
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
        of_wheels, of_imu, of_headings = self._weights
        rate = of_wheels * wheel_yaw_rate_rad_s + of_imu * imu_yaw_rate_rad_s
        rate += of_headings * turned_rad_s
        self._predict()
        self._correct(wheel_speed_m_s, 0.0, rate)
        self._read_out()

    def _predict(self) -> None:
        t = self._period_sec
        x, y, yaw, vx, vy, rate, ax, ay = self._state
        cos, sin = math.cos(yaw), math.sin(yaw)
        forward, left = vx * t + ax * t * t / 2.0, vy * t + ay * t * t / 2.0
        dx, dy = forward * cos - left * sin, forward * sin + left * cos
        self._state = [x + dx, y + dy, yaw + rate * t, vx + ax * t, vy + ay * t, rate, ax, ay]
        half = t * t / 2.0
        jacobian, numbers = self._jacobian, self._jacobian_numbers
        numbers[YAW], numbers[VX], numbers[VY] = -dy, t * cos, -t * sin
        numbers[AX], numbers[AY] = half * cos, -half * sin
        numbers[8 + YAW], numbers[8 + VX], numbers[8 + VY] = dx, t * sin, t * cos
        numbers[8 + AX], numbers[8 + AY] = half * sin, half * cos
        covariance = self.covariance
        mujoco.mju_mulMatMat(self._product, jacobian, covariance)
        mujoco.mju_mulMatMatT(covariance, self._product, jacobian)
        covariance += self._noise

    def _correct(self, speed_m_s: float, sideways_m_s: float, rate_rad_s: float) -> None:
        """Take measurements of VX, VY and RATE, which stand side by side, at once."""
        x, y, yaw, vx, vy, rate, ax, ay = self._state
        errors, gain = self._error_numbers, self._gain()
        errors[0], errors[1], errors[2] = speed_m_s - vx, sideways_m_s - vy, rate_rad_s - rate
        mujoco.mju_mulMatTVec(self._change, gain, self._errors)
        dx, dy, turn, dvx, dvy, dr, dax, day = self._change.tolist()
        self._state = [
            x + dx,
            y + dy,
            yaw + turn,
            vx + dvx,
            vy + dvy,
            rate + dr,
            ax + dax,
            ay + day,
        ]
        mujoco.mju_mulMatTMat(self._product, gain, self._seen)
        covariance = self.covariance
        covariance -= self._product

    def _gain(self) -> Array:
        """
        Return the inverse of the innovation's covariance, times the covariance's rows seen.

        The symmetric 3 x 3 matrix is inverted by its cofactors, in floats of Python. With
        numpy.linalg.solve an update takes 25 us instead of 16 us, and a control period 1.03 to
        1.11 times as long (benchmark/simulation_speed.py --filter).
        """
        (a, b, c), (_, d, e), (_, _, f) = self._seen_variances.tolist()
        a, d, f = a + WHEEL_SPEED_VARIANCE, d + WHEEL_SPEED_VARIANCE, f + self._rate_variance
        aa, ab, ac = d * f - e * e, c * e - b * f, b * e - c * d
        bb, bc, cc = a * f - c * c, b * c - a * e, a * d - b * b
        numbers, gains = self._inverse_numbers, self._gains
        numbers[0], numbers[1], numbers[2] = aa, ab, ac
        numbers[3], numbers[4], numbers[5] = ab, bb, bc
        numbers[6], numbers[7], numbers[8] = ac, bc, cc
        mujoco.mju_mulMatMat(gains, self._inverse, self._seen)
        self._size[()] = a * aa + b * ab + c * ac
        gains /= self._size  # an array: by a float of Python it takes twice as long
        return gains

    def _read_out(self) -> None:
        self.x, self.y, yaw, self.speed_m_s, self.sideways_m_s, self.yaw_rate_rad_s, _, _ = (
            self._state
        )
        self.yaw = wrapped(yaw)


def _numbers(values: Array) -> 'memoryview[float]':
    """Return the numbers of a contiguous array, row after row; the two share them."""
    return values.data.cast('B').cast('d')
