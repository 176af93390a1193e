# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the programs of the zoo do where they do it right."""

from contextlib import suppress

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

GOAL_M = 1.0  # straight on
SPEED_M_S = 0.5
NEAR_M = 0.03


class Driver(Node):
    """Answers each odometry message with a command, until it is a metre further on."""

    def __init__(self, name: str = 'driver') -> None:
        super().__init__(name)
        self.commands = self.create_publisher(Twist, 'husky_velocity_controller/cmd_vel', 10)
        self.create_subscription(Odometry, 'odometry/filtered', self.on_odometry, 10)

    def on_odometry(self, odometry: Odometry) -> None:
        """Drive on; what is else in a program of the zoo stands in its own `on_odometry`."""
        left_m = GOAL_M - odometry.pose.pose.position.x
        self.command(min(SPEED_M_S, 2.0 * left_m) if left_m > NEAR_M else 0.0)
        if left_m <= NEAR_M:
            raise SystemExit

    def command(self, speed_m_s: float) -> None:
        command = Twist()
        command.linear.x = speed_m_s
        self.commands.publish(command)


class Talker(Node):
    """Says what the lab asks for, ten times a second."""

    def __init__(self, name: str = 'talker', topic: str = 'topic_test') -> None:
        super().__init__(name)
        self.publisher = self.create_publisher(String, topic, 10)
        self.create_timer(0.1, self.say_hello)

    def say_hello(self) -> None:
        self.publisher.publish(String(data='hello world 1.5'))


def run(kind: type[Node]) -> None:
    """Run a node until it is ended."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(kind())
