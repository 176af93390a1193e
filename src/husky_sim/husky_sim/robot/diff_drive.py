# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The velocity controller: limits, timeout and wheel odometry, without physics or ROS.

It does what diff_drive_controller does for the Husky: one update every control period.
"""

import math

from husky_course.frames import wrapped

from husky_sim.config import DriveConfig


def limited(value: float, limit: float) -> float:
    """Cut a value to the range from -limit to limit."""
    below = value if value < limit else limit  # min and max take three times as long
    return below if below > -limit else -limit


def approached(current: float, target: float, step: float) -> float:
    """Move from current towards target by at most step."""
    return current + limited(target - current, step)


class VelocityController:
    """Turn velocity commands into wheel speeds."""

    def __init__(self, config: DriveConfig) -> None:
        self.config = config
        self.reset()

    def reset(self) -> None:
        """Forget every command and stand still."""
        self.asked_speed_m_s = self.asked_yaw_rate_rad_s = 0.0
        self.speed_m_s = self.yaw_rate_rad_s = 0.0
        self.timed_out = False
        self._asked_at_sec = -math.inf

    def command(self, speed_m_s: float, yaw_rate_rad_s: float, *, time_sec: float) -> None:
        """
        Take a command.

        :raises ValueError: if it is not finite; the robot is then commanded to stop.
        """
        self._asked_at_sec = time_sec
        if not (math.isfinite(speed_m_s) and math.isfinite(yaw_rate_rad_s)):
            self.asked_speed_m_s = self.asked_yaw_rate_rad_s = 0.0
            raise ValueError(
                f'linear.x={speed_m_s!r}, angular.z={yaw_rate_rad_s!r}: '
                'a velocity must be a finite number; stopping'
            )
        self.asked_speed_m_s = speed_m_s
        self.asked_yaw_rate_rad_s = yaw_rate_rad_s

    def update(self, *, time_sec: float, period_sec: float) -> bool:
        """
        Advance the limited velocity by one control period.

        :returns: whether the timeout has just begun to stop a moving robot.
        """
        config = self.config
        # 1e-9: rounding must not decide.
        late = time_sec - self._asked_at_sec > config.command_timeout_sec + 1e-9
        speed = 0.0 if late else self.asked_speed_m_s
        yaw_rate = 0.0 if late else self.asked_yaw_rate_rad_s
        begins = late and not self.timed_out and self.moving
        self.timed_out = late
        self.speed_m_s = approached(
            self.speed_m_s,
            limited(speed, config.speed_limit_m_s),
            config.acceleration_limit_m_s2 * period_sec,
        )
        self.yaw_rate_rad_s = approached(
            self.yaw_rate_rad_s,
            limited(yaw_rate, config.yaw_rate_limit_rad_s),
            config.yaw_acceleration_limit_rad_s2 * period_sec,
        )
        return begins

    @property
    def moving(self) -> bool:
        """Whether the wheels are commanded to turn."""
        return self.speed_m_s != 0.0 or self.yaw_rate_rad_s != 0.0

    def wheel_speeds_rad_s(self) -> tuple[float, float]:
        """Return the speeds of the left and the right wheels."""
        across = self.yaw_rate_rad_s * self.config.wheel_separation_m / 2.0
        radius = self.config.wheel_radius_m
        return (self.speed_m_s - across) / radius, (self.speed_m_s + across) / radius


class WheelOdometry:
    """
    The pose from the wheels alone: x, y and yaw in the frame `odom`.

    It drifts as a skid-steer robot's does, since wheels do not measure how far they slide.
    """

    def __init__(self, config: DriveConfig) -> None:
        self._config = config
        self.reset()

    def reset(self) -> None:
        """Start again at the origin, whatever the wheels' angles are."""
        self.x = self.y = self.yaw = 0.0
        self.speed_m_s = self.yaw_rate_rad_s = 0.0
        self._angles_rad: tuple[float, float] | None = None

    def update(self, left_rad: float, right_rad: float, *, period_sec: float) -> None:
        """
        Take the mean angles of the left and the right wheels, one control period on.

        The path between two updates is the arc of a circle.
        """
        if self._angles_rad is None:
            self._angles_rad = (left_rad, right_rad)
        radius = self._config.wheel_radius_m
        left_m = (left_rad - self._angles_rad[0]) * radius
        right_m = (right_rad - self._angles_rad[1]) * radius
        self._angles_rad = (left_rad, right_rad)
        distance_m = (left_m + right_m) / 2.0
        turned_rad = (right_m - left_m) / self._config.wheel_separation_m
        self.speed_m_s = distance_m / period_sec
        self.yaw_rate_rad_s = turned_rad / period_sec
        self.x, self.y = along_arc(self.x, self.y, self.yaw, distance_m, turned_rad)
        self.yaw = wrapped(self.yaw + turned_rad)


def along_arc(
    x: float, y: float, yaw: float, distance_m: float, turned_rad: float
) -> tuple[float, float]:
    """Move a point along an arc that begins in the direction yaw."""
    half = turned_rad / 2.0
    chord = distance_m * (math.sin(half) / half if abs(half) > 1e-6 else 1.0)
    return x + chord * math.cos(yaw + half), y + chord * math.sin(yaw + half)
