# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where the robot thinks it is: the wheels say how far, the IMU says which way."""

from husky_sim.diff_drive import along_arc, wrapped


class FusedOdometry:
    """
    The pose in the frame `odom`, from the distance the wheels rolled and the IMU's heading.

    The IMU's heading counts from its first value, as imu0_differential asks of the original's
    filter.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Start again at the origin."""
        self.x = 0.0
        self.y = 0.0
        self.yaw = 0.0
        self.speed_m_s = 0.0
        self.yaw_rate_rad_s = 0.0
        self._last_imu_yaw: float | None = None

    def update(
        self, *, distance_m: float, speed_m_s: float, imu_yaw: float, imu_yaw_rate_rad_s: float
    ) -> None:
        """Take one control period of wheel odometry and the IMU at its end."""
        if self._last_imu_yaw is None:
            self._last_imu_yaw = imu_yaw
        turned_rad = wrapped(imu_yaw - self._last_imu_yaw)
        self._last_imu_yaw = imu_yaw
        self.x, self.y = along_arc(self.x, self.y, self.yaw, distance_m, turned_rad)
        self.yaw = wrapped(self.yaw + turned_rad)
        self.speed_m_s = speed_m_s
        self.yaw_rate_rad_s = imu_yaw_rate_rad_s
