# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Log the bytes of what is said on chatter, as DDS carries them."""

from __future__ import annotations

import sys

from node_program import run_node
from rclpy.node import Node
from std_msgs.msg import String


class SerializedSubscriber(Node):
    """Asks for bytes: no message is made of them."""

    def __init__(self) -> None:
        super().__init__('serialized_subscriber')
        self.create_subscription(String, 'chatter', self._on_bytes, 10, raw=True)

    def _on_bytes(self, serialized: bytes) -> None:
        self.get_logger().info(f'I heard: "{serialized!r}"')


def main(args: list[str] | None = None) -> int:
    return run_node(lambda _: SerializedSubscriber(), sys.argv if args is None else args)


if __name__ == '__main__':
    sys.exit(main())
