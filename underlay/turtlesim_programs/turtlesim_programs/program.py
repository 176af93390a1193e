# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a node until a signal comes, as each program of turtlesim does."""

from __future__ import annotations

from collections.abc import Callable
import signal
import sys
import threading
from typing import TypeVar

import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

BAD_INPUT = 2
_LATENCY_SEC = 0.1  # the longest time until a signal is handled

AnyNode = TypeVar('AnyNode', bound=Node)


def spin(node: Node, stop: threading.Event) -> int:
    """Spin a node until it is to stop, and return the exit status."""
    executor = EventsExecutor()
    executor.add_node(node)
    # Always with a timeout: without one rclpy 7.1.6's EventsExecutor never wakes up.
    while not stop.is_set():
        executor.spin_once(timeout_sec=_LATENCY_SEC)
    executor.remove_node(node)  # before it is destroyed: the executor may hold its events
    executor.shutdown()
    return 0


def run_node(
    make: Callable[[], AnyNode],
    argv: list[str],
    use: Callable[[AnyNode, threading.Event], int] = spin,
) -> int:
    """
    Make a node, use it and let it go; return the exit status.

    :param use: returns soon after the event is set, which SIGINT and SIGTERM do.
    """
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    try:
        rclpy.init(args=argv, signal_handler_options=SignalHandlerOptions.NO)
        node = make()
    except Exception as error:  # rcl raises many types for wrong arguments
        rclpy.try_shutdown()
        return refuse(' '.join(str(error).split()))
    try:
        return use(node, stop)
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def own_words(argv: list[str]) -> list[str]:
    """Return what of a command line is not for ROS; nothing where `rclpy.init` will refuse it."""
    try:
        return remove_ros_args(argv)[1:]
    except RuntimeError:
        return []


def refuse(reason: str) -> int:
    """Say in one line why the program ends, and return its exit status."""
    print(reason, file=sys.stderr)
    return BAD_INPUT
