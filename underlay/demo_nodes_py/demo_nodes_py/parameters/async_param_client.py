# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Set, list, get, load and delete parameters of parameter_blackboard."""

from __future__ import annotations

from pathlib import Path
import sys

from ament_index_python import get_package_share_directory
from node_program import in_steps, run_node, Spinner
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_dict_from_yaml_file, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.task import Future

TARGET = 'parameter_blackboard'
TO_SET = {'int_parameter': 10, 'bool_parameter': False, 'string_parameter': 'Fee Fi Fo Fum'}
TO_DELETE = ('other_int_parameter', 'other_string_parameter', 'string_parameter')
_DEPTH = 10  # of names with dots, in the list
_WAIT_SEC = 3.0


class Tour:
    """Does one thing after another to the parameters of another node, and logs the answers."""

    def __init__(self, node: Node, spinner: Spinner) -> None:
        self._log = node.get_logger()
        self._spinner = spinner
        self._client = AsyncParameterClient(node, TARGET)

    def begin(self) -> bool:
        """Return whether the other node is there."""
        return self._spinner.until(self._client.services_are_ready, _WAIT_SEC)

    def set_some(self) -> None:
        self._log.info('Setting parameters:')
        values = [Parameter(name, value=value) for name, value in TO_SET.items()]
        for name, result in zip(
            TO_SET, self._results(self._client.set_parameters(values)), strict=False
        ):
            self._say(name, successful=result.successful)

    def list_them(self) -> None:
        self._log.info('Listing Parameters:')
        future = self._client.list_parameters(list(TO_SET), _DEPTH)
        self._spinner.until(future.done)
        for name in future.result().result.names:
            self._log.info(f'    - {name}')

    def get_them(self) -> None:
        self._log.info('Getting parameters:')
        future = self._client.get_parameters(list(TO_SET))
        self._spinner.until(future.done)
        for name, value in zip(TO_SET, future.result().values, strict=False):
            self._log.info(f'    - {name}: {parameter_value_to_python(value)}')

    def load_a_file(self, path: str) -> None:
        self._log.info('Loading parameters: ')
        results = self._results(self._client.load_parameter_file(path))
        for (name, parameter), result in zip(
            parameter_dict_from_yaml_file(path).items(), results, strict=False
        ):
            value = parameter_value_to_python(parameter.value)
            self._say(name, successful=result.successful, value=value)

    def delete_some(self) -> None:
        self._log.info('Deleting parameters: ')
        results = self._results(self._client.delete_parameters(list(TO_DELETE)))
        for name, result in zip(TO_DELETE, results, strict=False):
            self._say(name, successful=result.successful, reason=result.reason)

    def _results(self, future: Future[object]) -> list[SetParametersResult]:
        self._spinner.until(future.done)
        return list(future.result().results)

    def _say(self, name: str, **facts: object) -> None:
        self._log.info(f'    {name}:')
        for key, value in facts.items():
            self._log.info(f'        {key}: {value}')


def _steps(node: Node, spinner: Spinner) -> int:
    tour = Tour(node, spinner)
    if not tour.begin():
        node.get_logger().error(
            f'there is no node {TARGET}: start it before this demo by `ros2 run demo_nodes_cpp '
            f'{TARGET}`'
        )
        return 1
    tour.set_some()
    tour.list_them()
    tour.get_them()
    tour.load_a_file(str(Path(get_package_share_directory('demo_nodes_py')) / 'params.yaml'))
    tour.delete_some()
    return 0


def main(args: list[str] | None = None) -> int:
    return run_node(
        lambda _: Node('async_param_client'), sys.argv if args is None else args, in_steps(_steps)
    )


if __name__ == '__main__':
    sys.exit(main())
