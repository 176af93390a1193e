# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Change the log level of another node by its services, and see what it still logs."""

from __future__ import annotations

from functools import partial
import sys

from node_program import in_steps, run_node, Spinner
from rcl_interfaces.msg import LoggerLevel
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from std_msgs.msg import String

REMOTE = 'LoggerServiceNode'
LEVELS = {
    'debug': LoggingSeverity.DEBUG,
    'warn': LoggingSeverity.WARN,
    'error': LoggingSeverity.ERROR,
}
_WAIT_SEC = 2.0  # for a message, which may be lost


class LoggerServiceNode(Node):
    """Logs what it hears at every level; others may say which of them are shown."""

    def __init__(self) -> None:
        super().__init__(REMOTE, enable_logger_service=True)
        self.count = 0
        self.create_subscription(String, 'output', self._on_message, 10)

    def has_heard(self, count: int) -> bool:
        return self.count >= count

    def _on_message(self, message: String) -> None:
        self.count += 1
        log = self.get_logger()
        log.debug(f'{message.data} with DEBUG logger level.')
        log.info(f'{message.data} with INFO logger level.')
        log.warning(f'{message.data} with WARN logger level.')
        log.error(f'{message.data} with ERROR logger level.')


class TestNode(Node):
    """Talks to a node with a logger service, and asks for its level."""

    __test__ = False  # pytest: the name is upstream's

    def __init__(self, remote_node_name: str) -> None:
        super().__init__('TestNode')
        self._remote = remote_node_name
        self.output = self.create_publisher(String, 'output', 10)
        self.getting = self.create_client(GetLoggerLevels, f'{remote_node_name}/get_logger_levels')
        self.setting = self.create_client(SetLoggerLevels, f'{remote_node_name}/set_logger_levels')

    def is_connected(self) -> bool:
        services = self.getting.service_is_ready() and self.setting.service_is_ready()
        return services and self.output.get_subscription_count() > 0

    def set_level(self, level: LoggingSeverity, spinner: Spinner) -> None:
        wanted = LoggerLevel(name=self._remote, level=int(level))
        future = self.setting.call_async(SetLoggerLevels.Request(levels=[wanted]))
        spinner.until(future.done)
        (result,) = future.result().results
        if not result.successful:
            self.get_logger().error(f'Failed to change logger level: {result.reason}')

    def log_level(self, spinner: Spinner) -> None:
        future = self.getting.call_async(GetLoggerLevels.Request(names=[self._remote]))
        spinner.until(future.done)
        (answer,) = future.result().levels
        self.get_logger().info(f'Current logger level: {answer.level}')


def _steps(remote: LoggerServiceNode, spinner: Spinner) -> int:
    test = spinner.add(TestNode(REMOTE))
    spinner.until(test.is_connected)
    for number, name in enumerate(['default', *LEVELS], 1):
        test.get_logger().info(f'Output with {name} logger level:')
        if name in LEVELS:
            test.set_level(LEVELS[name], spinner)
        heard = remote.count + 1
        test.output.publish(String(data=f'Output {number}'))
        spinner.until(partial(remote.has_heard, heard), _WAIT_SEC)
        test.log_level(spinner)
    return 0


def main(args: list[str] | None = None) -> int:
    return run_node(
        lambda _: LoggerServiceNode(), sys.argv if args is None else args, in_steps(_steps)
    )


if __name__ == '__main__':
    sys.exit(main())
