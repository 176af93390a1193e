# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Let a service and a client tell what passes between them, as much as their parameters say.

`ros2 service echo --flow-style /add_two_ints` shows it, once a parameter is set:
`ros2 param set /introspection_client client_configure_introspection contents`.
"""

from __future__ import annotations

from collections.abc import Callable
import sys
import threading

from example_interfaces.srv import AddTwoInts
from node_program import run_node, spin
from rcl_interfaces.msg import SetParametersResult
from rclpy.client import Client
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_system_default
from rclpy.service import Service
from rclpy.service_introspection import ServiceIntrospectionState
from rclpy.task import Future

from demo_nodes_py.services.add_two_ints_server import AddTwoIntsServer

PERIOD_SEC = 0.5
STATES = {
    'disabled': ServiceIntrospectionState.OFF,
    'metadata': ServiceIntrospectionState.METADATA,
    'contents': ServiceIntrospectionState.CONTENTS,
}


def _configure_by_parameter(node: Node, end: Client | Service, name: str) -> None:
    """Declare the parameter that says what an end of a service tells."""

    def check(parameters: list[Parameter]) -> SetParametersResult:
        if all(p.value in STATES for p in parameters if p.name == name):
            return SetParametersResult(successful=True)
        reason = "must be one of 'disabled', 'metadata', or 'contents'"
        return SetParametersResult(successful=False, reason=reason)

    def apply(parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == name:
                state = STATES[parameter.value]
                end.configure_introspection(node.get_clock(), qos_profile_system_default, state)

    # Before it is declared: what the command line sets is checked and applied as well.
    node.add_on_set_parameters_callback(check)
    node.add_post_set_parameters_callback(apply)
    node.declare_parameter(name, 'disabled')


class IntrospectionServiceNode(AddTwoIntsServer):
    """Adds two integers, and tells of it."""

    def __init__(self) -> None:
        super().__init__('introspection_service')
        _configure_by_parameter(self, self.srv, 'service_configure_introspection')


class IntrospectionClientNode(Node):
    """Asks what two and three are, again and again, and tells of it."""

    def __init__(self) -> None:
        super().__init__('introspection_client')
        self.cli = self.create_client(AddTwoInts, 'add_two_ints')
        self._future: Future[AddTwoInts.Response] | None = None
        _configure_by_parameter(self, self.cli, 'client_configure_introspection')
        self.create_timer(PERIOD_SEC, self._on_tick)

    def _on_tick(self) -> None:
        if not self.cli.service_is_ready():
            return
        if self._future is None:
            self._future = self.cli.call_async(AddTwoInts.Request(a=2, b=3))
        elif self._future.done():
            self.get_logger().info(f'Result of add_two_ints: {self._future.result().sum}')
            self._future = None


def main(args: list[str] | None = None) -> int:
    clients: list[IntrospectionClientNode] = []

    def make(_: threading.Event) -> IntrospectionServiceNode:
        service = IntrospectionServiceNode()
        clients.append(IntrospectionClientNode())
        return service

    return run_node(make, sys.argv if args is None else args, _spin_with(clients))


def _spin_with(others: list[IntrospectionClientNode]) -> Callable[[Node, threading.Event], int]:
    def use(node: Node, stop: threading.Event) -> int:
        executor = SingleThreadedExecutor()
        for other in others:
            executor.add_node(other)
        try:
            return spin(node, stop, executor)
        finally:
            for other in others:
                other.destroy_node()

    return use


if __name__ == '__main__':
    sys.exit(main())
