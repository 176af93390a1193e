# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Say hello to the world once a second, on chatter."""

from __future__ import annotations

import sys

from node_program import run_node
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import String

PERIOD_SEC = 1.0


class Talker(Node):
    """Publishes numbered greetings."""

    def __init__(self, name: str = 'talker', qos: QoSProfile | int = 10) -> None:
        super().__init__(name)
        self.count = 0
        self._greetings = self.create_publisher(String, 'chatter', qos)
        self.create_timer(PERIOD_SEC, self._on_tick)

    def _on_tick(self) -> None:
        greeting = String(data=f'Hello World: {self.count}')
        self.count += 1
        self.get_logger().info(f'Publishing: "{greeting.data}"')
        self._greetings.publish(greeting)


def main(args: list[str] | None = None) -> int:
    return run_node(lambda _: Talker(), sys.argv if args is None else args)


if __name__ == '__main__':
    sys.exit(main())
