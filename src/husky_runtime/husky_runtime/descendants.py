# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Find, adopt and end the descendants of this process.

On Linux a process whose parent has ended gets as parent the next ancestor that is a subreaper
(`adopt_orphans`). A mark in the environment names the child that it came from.
"""

from collections.abc import Iterator, Sequence
import contextlib
import ctypes
import signal
import sys

import psutil

MARK = 'PLAYPEN_PROCESS'  # the environment variable
FIRM_SEC = 0.4  # from SIGTERM to SIGKILL
HURRIED_FIRM_SEC = 0.2  # the same after Ctrl-C

_PR_SET_CHILD_SUBREAPER = 36  # linux/prctl.h


def adopt_orphans() -> None:
    """Become the parent of every descendant that loses its own; on Linux only."""
    if sys.platform == 'linux':
        ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


@contextlib.contextmanager
def descendants_ended() -> Iterator[None]:
    """End every descendant that was started meanwhile, also one that has lost its mark."""
    adopt_orphans()
    before = descendants()
    firm_sec = FIRM_SEC
    try:
        yield
    except KeyboardInterrupt:
        firm_sec = HURRIED_FIRM_SEC
        raise
    finally:
        end_processes([each for each in descendants() if each not in before], firm_sec=firm_sec)


def descendants(*, mark: str = '') -> list[psutil.Process]:
    """Return the descendants of this process; where a mark is given, those that carry it."""
    found = psutil.Process().children(recursive=True)
    return [each for each in found if not mark or _mark_of(each) == mark]


def _mark_of(process: psutil.Process) -> str:
    try:
        return str(process.environ().get(MARK, ''))
    except psutil.Error:  # it has ended, or belongs to another user
        return ''


def end_processes(processes: Sequence[psutil.Process], *, firm_sec: float) -> None:
    """End processes that should have ended by themselves: SIGTERM, then SIGKILL."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        for process in processes:
            with contextlib.suppress(psutil.NoSuchProcess):
                process.send_signal(number)
        _, processes = psutil.wait_procs(processes, timeout=firm_sec)
