# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the programs share: a node that spins until a signal or until its work is done."""

from __future__ import annotations

from collections.abc import Callable
import signal
import sys

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

_SIGNAL_LATENCY_SEC = 0.2


def spin(make: Callable[[Callable[[], None]], Node]) -> None:
    """Spin a node; it is made with a function that ends the program.

    Signals only set a flag. rclpy's own handlers shut ROS down under whatever is being made, and
    one that comes just before the first wait is missed by it for good (rclpy 7.1.6).
    """
    finished = False

    def finish(*_: object) -> None:
        nonlocal finished
        finished = True

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, finish)
    rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    node = make(finish)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    while not finished:
        executor.spin_once(timeout_sec=_SIGNAL_LATENCY_SEC)
    executor.shutdown()
    node.destroy_node()
    rclpy.try_shutdown()
