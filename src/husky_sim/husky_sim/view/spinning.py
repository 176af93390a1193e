# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Spin a node until it is interrupted."""

import signal

from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.task import Future

SIGNAL_LATENCY_SEC = 0.2
"""How long a signal may go unnoticed: the executor looks at them only between two spins."""


def spin_until_interrupted(node: Node) -> None:
    """Spin with the executor that costs least, until SIGINT or SIGTERM."""
    executor = EventsExecutor()
    interrupted: Future[None] = Future(executor=executor)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: interrupted.done() or interrupted.set_result(None))
    executor.add_node(node)
    while not interrupted.done():
        executor.spin_until_future_complete(interrupted, timeout_sec=SIGNAL_LATENCY_SEC)
