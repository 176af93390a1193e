# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tell where the frame of a turtle is in the world."""

from __future__ import annotations

import sys

from node_program import run_node
from rclpy.node import Node
from tf2_py.motions import of_angles
from tf2_ros import TransformBroadcaster
from turtlesim.msg import Pose

from turtle_tf2_py.frames import placed, WORLD


class FramePublisher(Node):
    """Broadcasts each pose of the turtle that the parameter `turtlename` names."""

    def __init__(self) -> None:
        super().__init__('turtle_tf2_frame_publisher')
        self._turtle: str = self.declare_parameter('turtlename', 'turtle').value
        self._broadcaster = TransformBroadcaster(self)
        self.create_subscription(Pose, f'/{self._turtle}/pose', self._on_pose, 1)

    def _on_pose(self, pose: Pose) -> None:
        place = pose.x, pose.y, 0.0
        turn = of_angles(0.0, 0.0, pose.theta)
        now = self.get_clock().now().to_msg()
        self._broadcaster.sendTransform(placed(WORLD, self._turtle, place, turn, stamp=now))


def main(argv: list[str] | None = None) -> int:
    return run_node(lambda _: FramePublisher(), sys.argv if argv is None else argv)


if __name__ == '__main__':
    sys.exit(main())
