# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What goes in and out of a drive: odometry and velocity commands."""

from __future__ import annotations

import math
from typing import NamedTuple

STANDING_M_S = 0.01
STANDING_RAD_S = 0.02


class Odometry(NamedTuple):
    """Where the robot believes to be, in its odometry frame, and how it moves."""

    time_sec: float
    x_m: float
    y_m: float
    yaw_rad: float
    speed_m_s: float
    yaw_rate_rad_s: float

    @property
    def is_standing(self) -> bool:
        return abs(self.speed_m_s) < STANDING_M_S and abs(self.yaw_rate_rad_s) < STANDING_RAD_S


class Command(NamedTuple):
    """What the velocity controller is asked for."""

    speed_m_s: float
    yaw_rate_rad_s: float


STOP = Command(0.0, 0.0)


def yaw_of(x: float, y: float, z: float, w: float) -> float:
    """Return the heading of a quaternion."""
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def relative(x: float, y: float, origin: tuple[float, float, float]) -> tuple[float, float]:
    """Return a place as seen from a pose (x, y, yaw)."""
    cos, sin = math.cos(origin[2]), math.sin(origin[2])
    dx, dy = x - origin[0], y - origin[1]
    return cos * dx + sin * dy, cos * dy - sin * dx


def relative_odometry(odometry: Odometry, origin: Odometry) -> Odometry:
    """Return odometry of another frame as if it had begun at zero."""
    pose = (origin.x_m, origin.y_m, origin.yaw_rad)
    x, y = relative(odometry.x_m, odometry.y_m, pose)
    yaw = math.remainder(odometry.yaw_rad - origin.yaw_rad, 2 * math.pi)
    return odometry._replace(x_m=x, y_m=y, yaw_rad=yaw)
