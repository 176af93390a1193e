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
from functools import cache
import io
import os
from pathlib import Path
import signal
import sys
import threading

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


def pids_below(pid: int) -> list[int]:
    """
    Return the numbers of a process's descendants, for who looks again and again.

    It asks the kernel for the children of each thread (proc_pid_task(5)); psutil reads about every
    process of the computer instead. When a child ends amid a look, another may be left out of it.
    """
    if not _tells_children():
        try:
            return [each.pid for each in psutil.Process(pid).children(recursive=True)]
        except psutil.NoSuchProcess:
            return []
    found = _children_of(pid)
    for each in found:  # grows meanwhile
        found += _children_of(each)
    return found


@cache
def _tells_children() -> bool:
    """Return whether the kernel was built with such lists."""
    return Path(f'/proc/self/task/{threading.get_native_id()}/children').exists()


def _children_of(pid: int) -> list[int]:
    found: list[int] = []
    with contextlib.suppress(OSError), os.scandir(f'/proc/{pid}/task') as threads:
        for thread in threads:
            with (
                contextlib.suppress(OSError),  # it has ended
                io.FileIO(f'{thread.path}/children') as children,
            ):
                found += map(int, children.readall().split())
    return found


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
