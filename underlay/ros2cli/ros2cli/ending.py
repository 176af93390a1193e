# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The end of a command: what it used is given back when it has said all, and in time.

Fast DDS of the wheels may never come back from the end of a participant. Where another one is just
being discovered, it waits for that with a time-out that overflows (`DomainParticipant::
set_listener`, whose `pthread_cond_timedwait` then returns at once and keeps the mutex that the
discovery needs): it spins for ever, holds Python's lock, and hears no signal.
"""

from __future__ import annotations

from collections.abc import Callable
import contextlib
import signal
import sys
import threading

_WITHIN_SEC = 1.5  # an interrupted command must be gone in 2 s
_SIGNALS = (signal.SIGINT, signal.SIGTERM)  # are heard no more: it ends already

_left: list[Callable[[], object]] = []
_commands = 0  # that run


def at_end(action: Callable[[], object]) -> None:
    """Run an action when the command has ended; at once where none runs."""
    _left.append(action)
    if not _commands:
        run_now()


def run_now() -> None:
    """Run the actions that wait, without a limit."""
    while _left:
        _left.pop(0)()


def run_command(command: Callable[[], int]) -> int:
    """Run a command and then the actions that wait for its end; return its status.

    Where these take too long, the process ends with the status.
    """
    global _commands
    _commands += 1
    try:
        status = command()
    except BaseException:
        _commands -= 1
        run_now()
        raise
    _commands -= 1
    if not _left:
        return status
    from ros2cli.time_limit import exits_in  # what has no node needs none

    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):  # nobody reads, or the disk is full
            stream.flush()
    is_main = threading.current_thread() is threading.main_thread()
    before = {each: signal.signal(each, signal.SIG_IGN) for each in _SIGNALS if is_main}
    with exits_in(_WITHIN_SEC, status):
        run_now()
    for number, handler in before.items():
        signal.signal(number, handler)
    return status
