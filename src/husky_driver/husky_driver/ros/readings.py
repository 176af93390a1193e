# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read ROS messages, and check those that cannot be true."""

import math
from typing import Any

from nav_msgs.msg import Odometry as OdometryMsg
from sensor_msgs.msg import Imu, LaserScan

from husky_driver.checks.path_scan import Scan
from husky_driver.checks.plausibility import no_numbers, no_rotation
from husky_driver.motion import ImuReading, Odometry, read_imu, yaw_of

NOT_GIVEN = -1.0  # sensor_msgs/Imu: first covariance of a quantity that is not measured


def time_of(msg: Any) -> float:
    """Return the time of a message's stamp, in seconds."""
    stamp = msg.header.stamp
    return float(stamp.sec + stamp.nanosec * 1e-9)


def read_odometry(msg: OdometryMsg) -> Odometry:
    """Return the pose and the velocity of the message."""
    pose, twist = msg.pose.pose, msg.twist.twist
    position, q = pose.position, pose.orientation
    return Odometry(
        time_of(msg),
        position.x,
        position.y,
        yaw_of(q.x, q.y, q.z, q.w),
        twist.linear.x,
        twist.angular.z,
    )


def has_orientation(msg: Imu) -> bool:
    """Return whether the orientation is measured; gravity is subtracted with it."""
    return bool(msg.orientation_covariance[0] != NOT_GIVEN)


def read_imu_message(msg: Imu, ahead_m: float) -> ImuReading:
    """
    Return what an IMU at base_link would have measured.

    :param ahead_m: where it is. Turning draws it outwards; what it feels of a change of the turn
        is left in, because samples of a gyroscope tell that badly.
    """
    force, q = msg.linear_acceleration, msg.orientation
    forward = force.x + ahead_m * msg.angular_velocity.z**2
    return read_imu(time_of(msg), (forward, force.y), q.x, q.y, q.z, q.w)


def read_scan(msg: LaserScan) -> Scan:
    return Scan(time_of(msg), msg.ranges, msg.angle_min, msg.angle_increment)


def wrong_imu(msg: Imu) -> str:
    """Return why a message of the IMU cannot be true, or nothing."""
    force = msg.linear_acceleration
    measured = {
        'linear_acceleration.x': force.x,
        'linear_acceleration.y': force.y,
        'angular_velocity.z': msg.angular_velocity.z,
    }
    return no_rotation(msg.orientation) or no_numbers(measured)


def wrong_scan(msg: LaserScan) -> str:
    """Return why a scan cannot be true, or nothing; single ranges may be no numbers."""
    angles = {'angle_min': msg.angle_min, 'angle_increment': msg.angle_increment}
    return no_numbers(angles, 2 * math.pi + 0.01)
