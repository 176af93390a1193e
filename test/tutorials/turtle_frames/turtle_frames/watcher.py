# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Says which parameters change: one of its own, and the background of a turtlesim."""

from contextlib import suppress

import rclpy
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_event_handler import ParameterEventHandler


class Watcher(Node):
    """Keeps the handles, without which nothing is heard."""

    def __init__(self) -> None:
        super().__init__('watcher')
        self.declare_parameter('count', 0)
        self.handler = ParameterEventHandler(self)
        self.handles = [
            self.handler.add_parameter_callback(
                parameter_name=name, node_name=node, callback=self.on_change
            )
            for name, node in (('count', 'watcher'), ('background_r', 'turtlesim'))
        ]

    def on_change(self, parameter: object) -> None:
        value = parameter_value_to_python(parameter.value)  # type: ignore[attr-defined]
        self.get_logger().info(f'{parameter.name} is {value} now')  # type: ignore[attr-defined]


def main() -> None:
    rclpy.init()
    with suppress(KeyboardInterrupt):
        rclpy.spin(Watcher())
    rclpy.try_shutdown()
