# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tells once where something stands for ever: standing FRAME X Y Z."""

from contextlib import suppress
import sys

from geometry_msgs.msg import TransformStamped
import rclpy
from rclpy.node import Node
from tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster


class Standing(Node):
    """Sends one static transform."""

    def __init__(self, frame: str, place: list[float]) -> None:
        super().__init__('standing')
        self.broadcaster = StaticTransformBroadcaster(self)
        transform = TransformStamped()
        transform.header.stamp = self.get_clock().now().to_msg()
        transform.header.frame_id = 'world'
        transform.child_frame_id = frame
        translation = transform.transform.translation
        translation.x, translation.y, translation.z = place
        transform.transform.rotation.w = 1.0
        self.broadcaster.sendTransform(transform)


def main() -> None:
    if len(sys.argv) != 5:
        sys.exit('standing: give FRAME X Y Z')
    rclpy.init()
    with suppress(KeyboardInterrupt):
        rclpy.spin(Standing(sys.argv[1], [float(word) for word in sys.argv[2:]]))
    rclpy.try_shutdown()
