# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Subscribe to a topic and log its messages."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

from topic_demo.node_name import unique_node_name


class Subscriber(Node):
    """Logs its own name and every message of ``topic_test``."""

    def __init__(self) -> None:
        super().__init__(unique_node_name('subscriber'))
        self._subscription = self.create_subscription(String, 'topic_test', self._on_message, 10)

    def _on_message(self, message: String) -> None:
        self.get_logger().info(f'{self.get_fully_qualified_name()} heard {message.data}')


def main(args: list[str] | None = None) -> None:
    """Listen until Ctrl-C."""
    rclpy.init(args=args)
    node = Subscriber()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C is how this program ends
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
