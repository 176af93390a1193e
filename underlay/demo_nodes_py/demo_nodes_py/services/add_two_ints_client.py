# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ask what two and three are, log the answer and end."""

from __future__ import annotations

import sys

from example_interfaces.srv import AddTwoInts
from node_program import in_steps, run_node, Spinner
from rclpy.node import Node


def ask(node: Node, spinner: Spinner) -> int:
    client = node.create_client(AddTwoInts, 'add_two_ints')
    while not spinner.until(client.service_is_ready, timeout_sec=1.0):
        print('service not available, waiting again...', flush=True)
    future = client.call_async(AddTwoInts.Request(a=2, b=3))
    spinner.until(future.done)
    node.get_logger().info(f'Result of add_two_ints: {future.result().sum}')
    return 0


def main(args: list[str] | None = None) -> int:
    return run_node(
        lambda _: Node('add_two_ints_client'), sys.argv if args is None else args, in_steps(ask)
    )


if __name__ == '__main__':
    sys.exit(main())
