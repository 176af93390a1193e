# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Spawn a second turtle, and let it go where a frame is."""

from __future__ import annotations

import math
import sys

from geometry_msgs.msg import Twist
from node_program import run_node
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from turtle_tf2_py.spawned_turtle import SpawnedTurtle

FOLLOWER = 'turtle2'
PERIOD_SEC = 1.0
FORWARD = 0.5  # m/s a metre
TURN = 1.0  # rad/s a radian


class FrameListener(Node):
    """Sends turtle2 to the frame that the parameter `target_frame` names."""

    def __init__(self) -> None:
        super().__init__('turtle_tf2_frame_listener')
        self._target: str = self.declare_parameter('target_frame', 'turtle1').value
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._follower = SpawnedTurtle(self, FOLLOWER)
        self._commands = self.create_publisher(Twist, f'{FOLLOWER}/cmd_vel', 1)
        self.create_timer(PERIOD_SEC, self._on_timer)

    def _on_timer(self) -> None:
        if not self._follower.is_there():
            return
        try:
            seen = self._buffer.lookup_transform(FOLLOWER, self._target, Time())
        except TransformException as error:
            self.get_logger().info(f'Could not transform {FOLLOWER} to {self._target}: {error}')
            return
        place, twist = seen.transform.translation, Twist()
        twist.linear.x = FORWARD * math.hypot(place.x, place.y)
        twist.angular.z = TURN * math.atan2(place.y, place.x)
        self._commands.publish(twist)


def main(argv: list[str] | None = None) -> int:
    return run_node(lambda _: FrameListener(), sys.argv if argv is None else argv)


if __name__ == '__main__':
    sys.exit(main())
