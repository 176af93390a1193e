# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Spawn a third turtle, drive it in circles, and tell where it is as points of the world."""

from __future__ import annotations

import sys

from geometry_msgs.msg import PointStamped, Twist
from node_program import run_node
from rclpy.node import Node
from turtlesim.msg import Pose

from turtle_tf2_py.frames import WORLD
from turtle_tf2_py.spawned_turtle import SpawnedTurtle

DRIVEN = 'turtle3'
PERIOD_SEC = 1.0
DEPTH = 10


class PointPublisher(Node):
    """Answers each pose of turtle3 with a command and a point."""

    def __init__(self) -> None:
        super().__init__('turtle_tf2_message_broadcaster')
        self._turtle = SpawnedTurtle(self, DRIVEN)
        self._timer = self.create_timer(PERIOD_SEC, self._on_timer)

    def _on_timer(self) -> None:
        if not self._turtle.is_there():
            return
        self._timer.cancel()
        self._commands = self.create_publisher(Twist, f'{DRIVEN}/cmd_vel', DEPTH)
        self._points = self.create_publisher(PointStamped, f'{DRIVEN}/turtle_point_stamped', DEPTH)
        self.create_subscription(Pose, f'{DRIVEN}/pose', self._on_pose, DEPTH)

    def _on_pose(self, pose: Pose) -> None:
        twist = Twist()
        twist.linear.x = twist.angular.z = 1.0
        self._commands.publish(twist)
        point = PointStamped()
        point.header.stamp, point.header.frame_id = self.get_clock().now().to_msg(), WORLD
        point.point.x, point.point.y = pose.x, pose.y
        self._points.publish(point)


def main(argv: list[str] | None = None) -> int:
    return run_node(lambda _: PointPublisher(), sys.argv if argv is None else argv)


if __name__ == '__main__':
    sys.exit(main())
