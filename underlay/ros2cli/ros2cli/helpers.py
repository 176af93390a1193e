# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Small things that commands and verbs of any package share, under upstream's names."""

from __future__ import annotations

from argparse import ArgumentTypeError
from collections.abc import Callable
import math
import sys
import time

from ros2cli.discovery import settings_from_environment


def get_ros_domain_id() -> int:
    return settings_from_environment().domain_id


def wait_for(predicate: Callable[[], bool], timeout: float, period: float = 0.1) -> bool:
    """Wait until the predicate holds; return whether it does.

    :param timeout: in seconds; a negative one is endless.
    :param period: the time between two questions, in seconds.
    """
    end = time.monotonic() + (math.inf if timeout < 0 else timeout)
    while not predicate():
        if time.monotonic() > end:
            return predicate()
        time.sleep(period)
    return True


def unsigned_int(string: str) -> int:
    """Read a whole number, 0 or more, as the `type` of an argument.

    :raises ArgumentTypeError: it is none.
    """
    if not string.strip().isdecimal():
        raise ArgumentTypeError('value must be non-negative integer')
    return int(string)


def collect_stdin() -> bytes:
    """Read standard input to its end."""
    return sys.stdin.buffer.read()
