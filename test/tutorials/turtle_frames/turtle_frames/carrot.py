# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Holds a carrot before a turtle: a frame that hangs at another one, and may go around it."""

from contextlib import suppress
import math

from geometry_msgs.msg import TransformStamped
import rclpy
from rclpy.node import Node
from tf2_ros import TransformBroadcaster


class Carrot(Node):
    """Sends the frame carrot ten times a second."""

    def __init__(self) -> None:
        super().__init__('carrot')
        self.turns_per_second = self.declare_parameter('turns_per_second', 0.0).value
        self.broadcaster = TransformBroadcaster(self)
        self.timer = self.create_timer(0.1, self.on_timer)

    def on_timer(self) -> None:
        now = self.get_clock().now()
        angle = 2.0 * math.pi * self.turns_per_second * (now.nanoseconds / 1e9 % 1000.0)
        transform = TransformStamped()
        transform.header.stamp = now.to_msg()
        transform.header.frame_id = 'turtle1'
        transform.child_frame_id = 'carrot'
        transform.transform.translation.x = 2.0 * math.cos(angle)
        transform.transform.translation.y = 2.0 * math.sin(angle)
        self.broadcaster.sendTransform(transform)


def main() -> None:
    rclpy.init()
    with suppress(KeyboardInterrupt):
        rclpy.spin(Carrot())
    rclpy.try_shutdown()
