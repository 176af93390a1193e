# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Detect a robot that does not follow its commands."""

import math

from husky_driver.checks.bump import Bump
from husky_driver.motion import Command, Odometry, STANDING_M_S, STANDING_RAD_S

GAP_SEC = 0.2  # after a longer gap in odometry a command may have been late or lost
STUCK_SEC = 4.0
STUCK_MOVE_M = 0.02
STUCK_TURN_RAD = 0.03
SLIPPING_SEC = 1.0  # how long the yaw rate may differ from the command
SLIPPING_RAD_S = 0.3
SLIPPING_SHARE = 0.6


class Watchdog:
    """Compares commands with the motion in odometry."""

    def __init__(self, start: Odometry) -> None:
        self._judge_from(start)
        self.bump = Bump()

    def _judge_from(self, odometry: Odometry) -> None:
        self._last_sec = self._turning_well_sec = odometry.time_sec
        self._moved = odometry

    def complaint(self, odometry: Odometry, command: Command) -> str:
        """Return why the drive cannot go on, or nothing."""
        if odometry.time_sec - self._last_sec > GAP_SEC:
            self._judge_from(odometry)
        self._last_sec = odometry.time_sec
        place = f'({odometry.x_m:.2f}, {odometry.y_m:.2f})'
        if self._is_stuck(odometry, command):
            return (
                f'the robot does not move: told to drive {command.speed_m_s:.2f} m/s and turn '
                f'{command.yaw_rate_rad_s:.2f} rad/s, but for {STUCK_SEC:g} s its odometry has '
                f'stayed at {place}; does an emergency stop (e_stop) hold it?'
            )
        if self._is_slipping(odometry, command):
            return (
                f'the wheels slip: told to turn {command.yaw_rate_rad_s:.2f} rad/s, but it turns '
                f'{odometry.yaw_rate_rad_s:.2f} rad/s; is something in its way near {place}, its '
                'battery empty, or its emergency stop (e_stop) pressed?'
            )
        if self.bump.is_held(odometry.time_sec, odometry.speed_m_s, odometry.yaw_rate_rad_s):
            return (
                f'the wheels drive {odometry.speed_m_s:.2f} m/s, but the IMU has felt the robot '
                f'stop: something holds it near {place}'
            )
        return ''

    def _is_stuck(self, odometry: Odometry, command: Command) -> bool:
        moved = self._moved
        told = abs(command[0]) > STANDING_M_S or abs(command[1]) > STANDING_RAD_S
        turned = math.remainder(odometry.yaw_rad - moved.yaw_rad, 2 * math.pi)
        if (
            not told
            or math.hypot(odometry.x_m - moved.x_m, odometry.y_m - moved.y_m) > STUCK_MOVE_M
            or abs(turned) > STUCK_TURN_RAD
        ):
            self._moved = odometry
            return False
        return odometry.time_sec - moved.time_sec > STUCK_SEC

    def _is_slipping(self, odometry: Odometry, command: Command) -> bool:
        """
        Return whether the robot has turned too slowly for SLIPPING_SEC.

        The wheels of a robot that pushes against a wall go on turning, so its odometry goes on
        too; only the IMU's yaw rate shows that something holds it.
        """
        told = command.yaw_rate_rad_s
        lacking = (told - odometry.yaw_rate_rad_s) * math.copysign(1.0, told)
        if abs(told) < SLIPPING_RAD_S or lacking < SLIPPING_SHARE * abs(told):
            self._turning_well_sec = odometry.time_sec
        return odometry.time_sec - self._turning_well_sec > SLIPPING_SEC
