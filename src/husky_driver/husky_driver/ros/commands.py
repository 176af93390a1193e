# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of a driver, in the message that its robot takes."""

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node

from husky_driver.ros.settings import Interface

NO_STAMP = (-1, -1)


class Commands:
    """Publishes velocities as Twist or TwistStamped."""

    def __init__(self, node: Node, interface: Interface) -> None:
        self._stamped = TwistStamped() if interface.stamped else None
        self._twist = Twist() if self._stamped is None else self._stamped.twist
        kind = Twist if self._stamped is None else TwistStamped
        self.publisher = node.create_publisher(kind, interface.commands, 10)
        if self._stamped is not None:
            self._stamped.header.frame_id = 'base_link'

    def publish(
        self, speed_m_s: float, yaw_rate_rad_s: float, stamp: tuple[int, int] = NO_STAMP
    ) -> None:
        """
        Publish a command.

        :param stamp: seconds and nanoseconds of the odometry that it answers. That is the robot's
            own clock, whatever this computer's says; a robot counts one without a stamp from now.
        """
        self._twist.linear.x = speed_m_s
        self._twist.angular.z = yaw_rate_rad_s
        if self._stamped is None:
            self.publisher.publish(self._twist)
            return
        if stamp != NO_STAMP:
            time = self._stamped.header.stamp
            time.sec, time.nanosec = stamp
        self.publisher.publish(self._stamped)
