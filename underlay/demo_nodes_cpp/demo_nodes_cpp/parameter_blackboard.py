# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Keep every parameter that is given at the start or set later."""

from __future__ import annotations

import sys

from node_program import run_node
from rclpy.node import Node


class ParameterBlackboard(Node):
    """Takes parameters of any name, without declaring one."""

    def __init__(self) -> None:
        super().__init__(
            'parameter_blackboard',
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
        )
        count = len(self.list_parameters([], 0).names)
        self.get_logger().info(
            f"Parameter blackboard '{self.get_fully_qualified_name()}' is ready, with {count} "
            'parameters'
        )


def main(args: list[str] | None = None) -> int:
    return run_node(lambda _: ParameterBlackboard(), sys.argv if args is None else args)


if __name__ == '__main__':
    sys.exit(main())
