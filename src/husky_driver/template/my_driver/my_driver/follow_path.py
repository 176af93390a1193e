# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Drive the Husky along a path. To be completed: so far it drives to the first place and stops.

Copy the folder my_driver into the src of your workspace, build it, and let it be graded:

    ./lab grade --controller "ros2 run my_driver follow_path"
"""

import math

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# Where to drive, in metres: x is forward and y is left of where the Husky starts.
PATH = [(1.3, -1.2), (2.7, -2.6), (4.1, -3.2)]

SPEED = 0.5  # m/s; the Husky drives at most 1.0
TURN_RATE = 1.0  # rad/s; the Husky turns at most 2.0
NEAR = 0.2  # m


class FollowPath(Node):
    """Listens to where the robot is, and says how it shall move, fifty times a second."""

    def __init__(self) -> None:
        super().__init__('follow_path')
        self._next = 0  # which place of PATH comes next
        self._commands = self.create_publisher(Twist, 'husky_velocity_controller/cmd_vel', 10)
        self.create_subscription(Odometry, 'odometry/filtered', self._on_odometry, 10)

    def _on_odometry(self, msg: Odometry) -> None:
        place = msg.pose.pose.position
        goal_x, goal_y = PATH[self._next]
        distance = math.hypot(goal_x - place.x, goal_y - place.y)
        # How far to turn to face the goal, in radians, to the left positive.
        bearing = math.atan2(goal_y - place.y, goal_x - place.x)
        error = math.remainder(bearing - heading_of(msg), 2 * math.pi)

        command = Twist()
        if distance > NEAR:
            command.linear.x = SPEED if abs(error) < 0.3 else 0.0
            command.angular.z = max(-TURN_RATE, min(TURN_RATE, 2.0 * error))
        # TODO 1: when the goal is near and there is a next one, go on to that one.
        # TODO 2: slow down before the last place, so that the robot stops on it.
        # TODO 3: keep to the path between two places, not only to the places.
        self._commands.publish(command)


def heading_of(msg: Odometry) -> float:
    """Return the heading of a robot on a plane from its quaternion, in radians."""
    q = msg.pose.pose.orientation
    return 2.0 * math.atan2(q.z, q.w)


def main(args: list[str] | None = None) -> None:
    """Drive until Ctrl-C."""
    rclpy.init(args=args)
    node = FollowPath()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C is how this program ends
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
