# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Set param2 whenever param1 is set: what can be done before, while and after that happens."""

from __future__ import annotations

import sys

from node_program import run_node
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

PARAM2_WITH_PARAM1 = 4.0


class SetParametersCallback(Node):
    """Keeps the values of two parameters, and changes what somebody sets."""

    def __init__(self) -> None:
        super().__init__('set_parameters_callback')
        self.internal_tracked_param_1 = self.declare_parameter('param1', 0.0).value
        self.internal_tracked_param_2 = self.declare_parameter('param2', 0.0).value
        self.add_pre_set_parameters_callback(self._before_set)
        self.add_on_set_parameters_callback(self._on_set)
        self.add_post_set_parameters_callback(self._after_set)

    def _before_set(self, parameters: list[Parameter]) -> list[Parameter]:
        """Say what to set in place of what was asked for."""
        if all(parameter.name != 'param1' for parameter in parameters):
            return parameters
        return [*parameters, Parameter('param2', Parameter.Type.DOUBLE, PARAM2_WITH_PARAM1)]

    def _on_set(self, parameters: list[Parameter]) -> SetParametersResult:
        """Allow or refuse; here nothing must be changed yet, for another may still refuse."""
        return SetParametersResult(successful=True)

    def _after_set(self, parameters: list[Parameter]) -> None:
        """Use the new values."""
        for parameter in parameters:
            if parameter.name == 'param1':
                self.internal_tracked_param_1 = parameter.value
            elif parameter.name == 'param2':
                self.internal_tracked_param_2 = parameter.value


def main(args: list[str] | None = None) -> int:
    return run_node(lambda _: SetParametersCallback(), sys.argv if args is None else args)


if __name__ == '__main__':
    sys.exit(main())
