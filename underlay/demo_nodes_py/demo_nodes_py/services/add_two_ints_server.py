# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Add two integers for whoever asks."""

from __future__ import annotations

import sys

from example_interfaces.srv import AddTwoInts
from node_program import run_node
from rclpy.node import Node


class AddTwoIntsServer(Node):
    """Answers with the sum."""

    def __init__(self, name: str = 'add_two_ints_server') -> None:
        super().__init__(name)
        self.srv = self.create_service(AddTwoInts, 'add_two_ints', self._on_request)

    def _on_request(
        self, request: AddTwoInts.Request, response: AddTwoInts.Response
    ) -> AddTwoInts.Response:
        response.sum = request.a + request.b
        self.get_logger().info(f'Incoming request\na: {request.a} b: {request.b}')
        return response


def main(args: list[str] | None = None) -> int:
    return run_node(lambda _: AddTwoIntsServer(), sys.argv if args is None else args)


if __name__ == '__main__':
    sys.exit(main())
