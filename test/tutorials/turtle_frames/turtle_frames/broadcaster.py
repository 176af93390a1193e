# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tells where a turtle is in the frame world."""

from contextlib import suppress
import math

from geometry_msgs.msg import TransformStamped
import rclpy
from rclpy.node import Node
from tf2_ros import TransformBroadcaster
from turtlesim.msg import Pose


class Broadcaster(Node):
    """Sends a transform for each pose of a turtle."""

    def __init__(self) -> None:
        super().__init__('broadcaster')
        self.turtle = self.declare_parameter('turtle', 'turtle').get_parameter_value().string_value
        self.broadcaster = TransformBroadcaster(self)
        self.subscription = self.create_subscription(Pose, f'/{self.turtle}/pose', self.on_pose, 1)

    def on_pose(self, pose: Pose) -> None:
        transform = TransformStamped()
        transform.header.stamp = self.get_clock().now().to_msg()
        transform.header.frame_id = 'world'
        transform.child_frame_id = self.turtle
        transform.transform.translation.x = pose.x
        transform.transform.translation.y = pose.y
        transform.transform.rotation.z = math.sin(pose.theta / 2.0)
        transform.transform.rotation.w = math.cos(pose.theta / 2.0)
        self.broadcaster.sendTransform(transform)


def main() -> None:
    rclpy.init()
    with suppress(KeyboardInterrupt):
        rclpy.spin(Broadcaster())
    rclpy.try_shutdown()
