# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry, which a drive takes, and velocity commands, which it returns."""

from collections.abc import Sequence
import math
from typing import NamedTuple

from husky_course.frames import Pose, to_odom, wrapped

GRAVITY_M_S2 = 9.81
STANDING_M_S = 0.01
STANDING_RAD_S = 0.02


class Odometry(NamedTuple):
    """The estimated pose of the robot, in its odometry frame, and its velocity."""

    time_sec: float
    x_m: float
    y_m: float
    yaw_rad: float
    speed_m_s: float
    yaw_rate_rad_s: float

    @property
    def is_standing(self) -> bool:
        return abs(self.speed_m_s) < STANDING_M_S and abs(self.yaw_rate_rad_s) < STANDING_RAD_S


class ImuReading(NamedTuple):
    """What the IMU measures in the plane; accelerations of the robot, without gravity."""

    time_sec: float
    yaw_rad: float
    forward_m_s2: float
    left_m_s2: float


class Command(NamedTuple):
    """A command for the velocity controller."""

    speed_m_s: float
    yaw_rate_rad_s: float


AT_ORIGIN = Odometry(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
STOP = Command(0.0, 0.0)


def read_imu(
    time_sec: float, force: tuple[float, float], x: float, y: float, z: float, w: float
) -> ImuReading:
    """
    Return what a sample of an IMU says, without the part of gravity that an inclined one feels.

    :param force: of the accelerometer, forwards and to the left, m/s2; x, y, z, w: orientation.
    """
    return ImuReading(
        time_sec,
        yaw_of(x, y, z, w),
        force[0] - GRAVITY_M_S2 * 2.0 * (x * z - w * y),
        force[1] - GRAVITY_M_S2 * 2.0 * (y * z + w * x),
    )


def mean_reading(readings: Sequence[ImuReading]) -> ImuReading:
    """Return the last reading, with the mean of all accelerations."""
    count = len(readings)
    return readings[-1]._replace(
        forward_m_s2=math.fsum(each.forward_m_s2 for each in readings) / count,
        left_m_s2=math.fsum(each.left_m_s2 for each in readings) / count,
    )


def yaw_of(x: float, y: float, z: float, w: float) -> float:
    """Return the heading of a quaternion."""
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def relative_odometry(odometry: Odometry, start: Pose) -> Odometry:
    """
    Return odometry of the frame world in the frame odom.

    :param start: where the robot starts in the frame world.
    """
    x, y = to_odom(start, odometry.x_m, odometry.y_m)
    yaw = wrapped(odometry.yaw_rad - start[2])
    return odometry._replace(x_m=x, y_m=y, yaw_rad=yaw)
