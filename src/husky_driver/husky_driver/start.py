# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Starts the programs of this package so that they can be interrupted at any moment."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
import signal

_INTERRUPTED = 130  # as of a program that SIGINT ends


@contextmanager
def signals_held_back() -> Iterator[None]:
    """Let SIGINT and SIGTERM wait until a node is made: rclpy would lose the exception."""
    came: list[int] = []
    before = {
        number: signal.signal(number, lambda number, _: came.append(number))
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if came:
            signal.raise_signal(came[0])


def _run(module: str, *, node: bool, catches: bool = True) -> int:
    try:
        from husky_sim import start
    except ImportError:  # on a real robot there is no simulator, and Python's own start must do
        return int(import_module(module).main())
    run = start.run_node if node else start.run
    return run(module, interrupted=_INTERRUPTED, catches=catches)


def check() -> int:
    """Check waypoint files."""
    return _run('husky_driver.check', node=False)


def drive() -> int:
    """Drive a path in the playpen, and report."""
    return _run('husky_driver.drive_command', node=False, catches=False)


def follow_path() -> int:
    """Drive along a waypoint file."""
    return _run('husky_driver.follow_path', node=True)


def grade() -> int:
    """Judge waypoint files, records and controllers."""
    return _run('husky_driver.grade', node=False)


def supervise() -> int:
    """Run a command, and leave nothing of what it started."""
    return _run('husky_driver.supervise', node=False, catches=False)


def teleop() -> int:
    """Drive by the keys."""
    return _run('husky_driver.teleop', node=True)
