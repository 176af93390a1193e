# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A node that keeps everything it hears, and says what it is told to say."""

from typing import Any

from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import QoSProfile

from playpen_testing.waiting import wait_until

QOS = QoSProfile(depth=1000)


class Listener(Node):
    """Listens to topics on behalf of a test."""

    def __init__(self, topics: dict[str, type], **arguments: Any) -> None:
        super().__init__('listener', **arguments)
        self.heard: dict[str, list[Any]] = {topic: [] for topic in topics}
        for topic, kind in topics.items():
            self.create_subscription(kind, topic, self.heard[topic].append, QOS)
        self._commands = self.create_publisher(Twist, 'husky_velocity_controller/cmd_vel', 10)

    def latest(self, topic: str) -> Any:
        """Return the newest message of a topic, waiting for the first."""
        wait_until(lambda: bool(self.heard[topic]), timeout_sec=10.0, what=f'a message on {topic}')
        return self.heard[topic][-1]

    def command(self, speed_m_s: float, yaw_rate_rad_s: float = 0.0) -> None:
        """Publish one velocity command, once somebody listens."""
        wait_until(
            lambda: self._commands.get_subscription_count() > 0,
            timeout_sec=10.0,
            what=f'a node that listens to {self._commands.topic_name}',
        )
        twist = Twist()
        twist.linear.x = speed_m_s
        twist.angular.z = yaw_rate_rad_s
        self._commands.publish(twist)
