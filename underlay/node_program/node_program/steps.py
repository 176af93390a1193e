# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Programs that do one thing after another while their nodes are spun."""

from __future__ import annotations

from collections.abc import Callable
import math
import threading
import time
from typing import TypeVar

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

_LATENCY_SEC = 0.1  # the longest time until a signal, or a fact without an event, is noticed

AnyNode = TypeVar('AnyNode', bound=Node)


class Interrupted(Exception):
    """A signal came before a fact."""


class Spinner:
    """Spins nodes until facts hold; destroys those that it is given later."""

    def __init__(self, node: Node, stop: threading.Event) -> None:
        self._stop = stop
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(node)
        self._nodes = [node]

    def add(self, node: AnyNode) -> AnyNode:
        """Spin another node as well, and destroy it in the end."""
        self._executor.add_node(node)
        self._nodes.append(node)
        return node

    def until(self, fact: Callable[[], bool], timeout_sec: float = math.inf) -> bool:
        """
        Spin until a fact holds; return whether it does.

        :raises Interrupted: a signal came.
        """
        end = time.monotonic() + timeout_sec
        while not fact():
            left = end - time.monotonic()
            if left <= 0.0:
                return False
            if self._stop.is_set():
                raise Interrupted
            self._executor.spin_once(timeout_sec=min(left, _LATENCY_SEC))
        return True

    def close(self) -> None:
        for node in reversed(self._nodes):
            self._executor.remove_node(node)  # before it is destroyed, see `spin`
        self._executor.shutdown()
        for node in self._nodes[:0:-1]:
            node.destroy_node()


def in_steps(
    steps: Callable[[AnyNode, Spinner], int],
) -> Callable[[AnyNode, threading.Event], int]:
    """Return the function that `run_node` is to use a node by, from one that takes a Spinner."""

    def use(node: AnyNode, stop: threading.Event) -> int:
        spinner = Spinner(node, stop)
        try:
            return steps(node, spinner)
        except Interrupted:
            return 0
        finally:
            spinner.close()

    return use
