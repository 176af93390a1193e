# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Say hello on a topic ten times a second."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

from topic_demo.node_name import unique_node_name

PERIOD_SEC = 0.1  # 10 Hz, as the lab sheet asks


class Publisher(Node):
    """Publishes ``hello world <time in seconds>`` on ``topic_test``."""

    def __init__(self) -> None:
        super().__init__(unique_node_name('publisher'))
        # 10 messages wait in the queue when a subscriber is slow; older ones are dropped.
        self._publisher = self.create_publisher(String, 'topic_test', 10)
        self._timer = self.create_timer(PERIOD_SEC, self._on_timer)

    def _on_timer(self) -> None:
        now_sec = self.get_clock().now().nanoseconds / 1e9
        text = f'hello world {now_sec}'
        self.get_logger().info(text)
        self._publisher.publish(String(data=text))


def main(args: list[str] | None = None) -> None:
    """Publish until Ctrl-C."""
    rclpy.init(args=args)
    node = Publisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C is how this program ends
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
