# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node of a command that takes part in the graph: hidden, and gone when the command ends."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from contextlib import contextmanager
import os
import time
from typing import Any

import rclpy
from rclpy.exceptions import InvalidNodeNameException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rtps_graph import names

from ros2cli import discovery
from ros2cli.errors import CommandError


class CommandNode:
    """A node with its executor."""

    def __init__(self, args: argparse.Namespace | None, *, node_name: str | None = None) -> None:
        discovery.settings_from_environment()
        rclpy.init(args=[])
        use_sim_time = bool(getattr(args, 'use_sim_time', False))
        try:
            self.node = Node(
                node_name or f'{names.COMMAND_NODE}{os.getpid()}',
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=False,
                parameter_overrides=[Parameter('use_sim_time', value=use_sim_time)],
            )
        except InvalidNodeNameException as error:
            rclpy.try_shutdown()
            raise CommandError(' '.join(str(error).split())) from None
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)

    def spin_once(self, timeout_sec: float | None = None) -> None:
        self._executor.spin_once(timeout_sec)

    def spin_until(self, done: Callable[[], bool], timeout_sec: float | None = None) -> bool:
        """Spin until `done()`; False where `timeout_sec` passed before that."""
        end = None if timeout_sec is None else time.monotonic() + timeout_sec
        while not done():
            if end is not None and time.monotonic() >= end:
                return False
            self._executor.spin_once(0.02 if end is None else min(0.02, end - time.monotonic()))
        return True

    def destroy(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown()


class DirectNode(CommandNode):
    """The node as upstream's verbs use it: a context manager that has what the node has."""

    def __init__(self, args: argparse.Namespace | None, *, node_name: str | None = None) -> None:
        super().__init__(args, node_name=node_name)
        self._args = args

    def __enter__(self) -> DirectNode:
        """Wait until the node has discovered the others."""
        others = {node.full_name for node in discovery.read_graph(self._args, quiet=True).nodes}
        self.spin_until(lambda: others <= self._discovered(), discovery.DEFAULT_TIMEOUT_SEC)
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.__dict__['node'], name)

    def _discovered(self) -> set[str]:
        found = self.node.get_node_names_and_namespaces()
        return {names.full_node_name(namespace, name) for name, namespace in found}


@contextmanager
def command_node(
    args: argparse.Namespace | None = None, *, name: str | None = None
) -> Iterator[CommandNode]:
    """Give a node for the time of a command; Ctrl-C and SIGTERM end it cleanly."""
    node = CommandNode(args, node_name=name)
    try:
        yield node
    except ExternalShutdownException:
        raise KeyboardInterrupt from None
    finally:
        node.destroy()
