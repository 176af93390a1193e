# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Log what is said on chatter."""

from __future__ import annotations

import sys

from node_program import run_node
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import String


class Listener(Node):
    """Logs each message that it hears."""

    def __init__(self, name: str = 'listener', qos: QoSProfile | int = 10) -> None:
        super().__init__(name)
        self.count = 0
        self.create_subscription(String, 'chatter', self._on_message, qos)

    def _on_message(self, message: String) -> None:
        self.count += 1
        self.get_logger().info(f'I heard: [{message.data}]')


def main(args: list[str] | None = None) -> int:
    return run_node(lambda _: Listener(), sys.argv if args is None else args)


if __name__ == '__main__':
    sys.exit(main())
