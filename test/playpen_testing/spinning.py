# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Spin real nodes in this process, each with its own context, executor and thread."""

from collections.abc import Callable
from contextlib import suppress
import threading
from typing import TypeVar

import rclpy
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.task import Future

from playpen_testing.waiting import wait_until

AnyNode = TypeVar('AnyNode', bound=Node)


def do_in_thread_of(node: Node, act: Callable[..., object], *arguments: object) -> None:
    """
    Do something in the thread that spins a node, and wait until it is done.

    An executor fails on what another thread destroys while it makes ready to wait.
    """
    assert node.executor is not None, f'{node.get_name()} is not spun'
    task = node.executor.create_task(act, *arguments)
    wait_until(task.done, timeout_sec=10.0, what=lambda: f'the end of {act}')


class SpunNode:
    """A node and the thread that serves it."""

    def __init__(self, context: Context, node: Node) -> None:
        self.context = context
        self.node = node
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(node)
        self._closing: Future[None] = Future()
        self._thread = threading.Thread(target=self._spin, daemon=True)

    def start(self) -> None:
        self._thread.start()

    def _spin(self) -> None:
        with suppress(ExternalShutdownException):
            self._executor.spin_until_future_complete(self._closing)

    def close(self) -> None:
        """Stop serving after the callback that runs, then let the node go; may be called twice."""
        if not self._closing.done():
            self._closing.set_result(None)
        if self._thread.ident is not None:  # it was started
            self._thread.join(timeout=10.0)
        assert not self._thread.is_alive(), f'{self.node.get_name()} still spins after 10 s'
        self._executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()


class SpunNodes:
    """The nodes of one test, closed in reverse."""

    def __init__(self, domain_id: int) -> None:
        self._domain_id = domain_id
        self._spun: list[SpunNode] = []

    def start(
        self,
        make: Callable[..., AnyNode],
        *arguments: object,
        before_spin: Callable[[AnyNode], object] = lambda _: None,
        **parameters: object,
    ) -> AnyNode:
        """
        Make a node with these parameters and spin it in a thread of its own.

        :param before_spin: called with the node before any of its callbacks can run.
        """
        context = Context()
        rclpy.init(context=context, domain_id=self._domain_id)
        overrides = [Parameter(name, value=value) for name, value in parameters.items()]
        node = make(*arguments, context=context, parameter_overrides=overrides)
        before_spin(node)
        # Kept first: an interrupt while the thread starts must not leave it running.
        self._spun.append(SpunNode(context, node))
        self._spun[-1].start()
        return node

    def close(self, node: Node) -> None:
        """End one node before the others."""
        for spun in self._spun:
            if spun.node is node:
                spun.close()
                self._spun.remove(spun)
                return

    def __enter__(self) -> 'SpunNodes':
        return self

    def __exit__(self, *_: object) -> None:
        for spun in reversed(self._spun):
            spun.close()
