# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Spin nodes with the executor that takes the least CPU time."""

import signal
from typing import Any

import rclpy
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future

SIGNAL_LATENCY_SEC = 0.2
"""The longest time until a signal is handled."""


def make_executor(context: rclpy.Context | None = None) -> Executor:
    """Return the executor with the least overhead that this rclpy has."""
    try:
        from rclpy.experimental import EventsExecutor
    except ImportError:  # early Jazzy releases
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)


def future_of_signal() -> 'Future[None]':
    """
    Return a future that SIGINT or SIGTERM completes.

    A signal lets the callback that runs finish, so that a run ends with a whole control period.
    """
    interrupted: Future[None] = Future()

    def on_signal(*_: object) -> None:
        if not interrupted.done():
            interrupted.set_result(None)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, on_signal)
    return interrupted


def spin(node: Node, *, until: 'Future[Any]', or_until: 'Future[Any] | None' = None) -> None:
    """Spin a node until a future is done, or another."""
    executor = make_executor()
    executor.add_node(node)
    # Always with a timeout, and one event at a time: rclpy 7.1.6's EventsExecutor handles signals
    # only between two spins, and ignores the timeout of a longer one while a timer is always due.
    while not (until.done() or (or_until and or_until.done())):
        executor.spin_once(timeout_sec=SIGNAL_LATENCY_SEC)
    executor.remove_node(node)  # before it is destroyed: the executor may hold its events
    executor.shutdown()
