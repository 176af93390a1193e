# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a node until a signal comes, or until its work is done."""

from __future__ import annotations

from collections.abc import Callable
import gc
import os
import signal
import sys
import threading
from typing import TypeVar

import rclpy
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

BAD_INPUT = 2
BROKEN_PIPE = 128 + signal.SIGPIPE
_LATENCY_SEC = 0.1  # the longest time until a signal is handled

AnyNode = TypeVar('AnyNode', bound=Node)


def spin(node: Node, stop: threading.Event, executor: Executor | None = None) -> int:
    """
    Spin a node until it is to stop, and return the exit status.

    :param executor: None: a SingleThreadedExecutor.
    """
    executor = executor or SingleThreadedExecutor()
    executor.add_node(node)
    # Always with a timeout: no executor wakes up for an event that is set just before it waits.
    while not stop.is_set():
        executor.spin_once(timeout_sec=_LATENCY_SEC)
    executor.remove_node(node)  # before it is destroyed: the executor may hold its events
    executor.shutdown()
    return 0


def run_node(
    make: Callable[[threading.Event], AnyNode],
    argv: list[str],
    use: Callable[[AnyNode, threading.Event], int] = spin,
) -> int:
    """
    Make a node, use it and let it go; return the exit status.

    Signals only set an event. rclpy's own handlers shut ROS down under whatever is being made, and
    one that comes just before the first wait is missed by it for good (rclpy 7.1.6).

    :param make: is given the event, for a node whose work may be done.
    :param use: returns soon after the event is set, which a signal does.
    """
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        # A terminal that is closed sends SIGHUP; nohup has it ignored.
        if number != signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda *_: stop.set())
    try:
        rclpy.init(args=argv, signal_handler_options=SignalHandlerOptions.NO)
        node = make(stop)
    except Exception as error:  # rcl raises many types for wrong arguments
        rclpy.try_shutdown()
        return refuse(' '.join(str(error).split()))
    gc.freeze()  # no collection, nor the last one, looks at what is there now
    try:
        return use(node, stop)
    except BrokenPipeError:
        # Who has read its output (`head`) is gone; Python must not flush into the pipe.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return BROKEN_PIPE
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def own_words(argv: list[str]) -> list[str]:
    """Return what of a command line is not for ROS; end the program where that is wrong."""
    try:
        return remove_ros_args(argv)[1:]
    except RuntimeError as error:
        raise SystemExit(refuse(f'wrong ROS arguments: {" ".join(str(error).split())}')) from None


def refuse(reason: str) -> int:
    """Say in one line why the program ends, and return its exit status."""
    print(reason, file=sys.stderr)
    return BAD_INPUT
