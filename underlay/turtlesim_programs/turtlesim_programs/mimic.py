# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Move a turtle as another moves: remap input/pose and output/cmd_vel to theirs."""

from __future__ import annotations

import sys

from geometry_msgs.msg import Twist
from node_program import run_node
from rclpy.node import Node
from turtlesim.msg import Pose

from turtlesim_programs.turtle_topics import QOS


class Mimic(Node):
    """Publishes as a command what it hears of a turtle's velocities."""

    def __init__(self) -> None:
        super().__init__('turtle_mimic')
        self._commands = self.create_publisher(Twist, 'output/cmd_vel', QOS)
        self.create_subscription(Pose, 'input/pose', self._on_pose, QOS)

    def _on_pose(self, pose: Pose) -> None:
        twist = Twist()
        twist.linear.x, twist.angular.z = pose.linear_velocity, pose.angular_velocity
        self._commands.publish(twist)


def main(argv: list[str] | None = None) -> int:
    return run_node(lambda _: Mimic(), sys.argv if argv is None else argv)


if __name__ == '__main__':
    sys.exit(main())
