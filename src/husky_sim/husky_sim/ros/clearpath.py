# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What a real A200 offers on ROS 2 Jazzy, beside the topics of the lab.

Names, types and QoS: Clearpath's Platform API and Sensors API for ROS 2 Jazzy
(docs.clearpathrobotics.com). Frames, rates and timeouts: clearpath_common, clearpath_control.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.qos import qos_profile_sensor_data, QoSProfile
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Bool

from husky_sim.messages import messages
from husky_sim.messages.packed_message import PackedMessage

NAME = 'clearpath'  # of the interface
COMMANDS = 'cmd_vel'
FILTERED = 'platform/odom/filtered'
SCAN, SCAN_FRAME = 'sensors/lidar2d_0/scan', 'lidar2d_0_laser'
FIX, FIX_FRAME = 'sensors/gps_0/fix', 'gps_0_link'
IMU_FRAME = 'imu_0_link'
IMAGE, CAMERA_INFO = 'sensors/camera_0/color/image', 'sensors/camera_0/color/camera_info'
CAMERA_FRAME = 'camera_0_color_optical_frame'
BATTERY = 'platform/bms/state'
SYSTEM_DEFAULT = QoSProfile(depth=10)
STAMP_TIMEOUT_SEC = 0.5
"""Older commands are refused: cmd_vel_timeout of platform_velocity_controller."""


class Measured(NamedTuple):
    """A message of each control period."""

    message: PackedMessage
    kind: Any
    topic: str
    qos: QoSProfile


def measured() -> list[Measured]:
    """Return what is published of every control period, besides the filtered odometry."""
    return [
        Measured(messages.WheelOdometryMessage(), Odometry, 'platform/odom', SYSTEM_DEFAULT),
        Measured(
            messages.StampedCommandMessage(), TwistStamped, 'platform/cmd_vel', SYSTEM_DEFAULT
        ),
        Measured(
            messages.ImuMessage(IMU_FRAME), Imu, 'sensors/imu_0/data', qos_profile_sensor_data
        ),
        Measured(
            messages.JointStateMessage(), JointState, 'platform/joint_states', SYSTEM_DEFAULT
        ),
        Measured(
            messages.EmergencyStopMessage(),
            Bool,
            'platform/emergency_stop',
            qos_profile_sensor_data,
        ),
    ]


class StampedCommands:
    """
    Takes the commands whose stamp is not too old, as the robot's controller does.

    :param take: is given the command: m/s forward, rad/s to the left.
    :param now_sec: returns the simulated time.
    """

    def __init__(
        self,
        take: Callable[[float, float], None],
        now_sec: Callable[[], float],
        name: str,
        logger: RcutilsLogger,
    ) -> None:
        self._take, self._now_sec, self._name, self._logger = take, now_sec, name, logger

    def on_message(self, message: TwistStamped) -> None:
        """Take a command: one without a stamp is of now, one from the future is taken, too."""
        stamp = message.header.stamp
        stamp_sec = stamp.sec + stamp.nanosec / 1e9
        age_sec = self._now_sec() - stamp_sec
        if stamp_sec == 0.0 and age_sec > STAMP_TIMEOUT_SEC:
            self._logger.warning(
                f'{self._name}: {COMMANDS} has no stamp: it counts as one of now', once=True
            )
        elif age_sec > STAMP_TIMEOUT_SEC:
            self._logger.warning(
                f'{self._name}: refused a command that was stamped {age_sec:.2f} s ago; at most '
                f'{STAMP_TIMEOUT_SEC} s are allowed: stamp each with the time of /clock '
                '(use_sim_time), and start again after a reset',
                throttle_duration_sec=1.0,
            )
            return
        self._take(message.twist.linear.x, message.twist.angular.z)
