# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Tell when a controller is at rest: it has handled all that it was told, and what it says is out.

Nobody can ask this of a program that is not known, but the kernel knows which threads sleep, and
how often each has run (proc_pid_status(5)). When all sleep, and none has run between two looks,
then all slept at the moment between the looks. No message is under way at such a moment: who sends
one on this computer wakes the thread that waits for it, before it goes on itself. The threads of
this process count too, for one of them takes what the controller sends.
"""

from collections.abc import Iterator, Sequence
import os
from pathlib import Path
import threading
import time

from husky_course.files import replacing
from husky_runtime.descendants import pids_below

LOOK_FOR_SEC = 0.5
"""Wall time between two looks for new processes; to import rclpy takes one nearly as long."""

_BUSY = b'RD'  # it runs or is about to, or it waits for a disk
_ENDED = b'ZX'

_STATUS_BYTES = 1 << 16  # more than it has, and so read at once
_STATE, _TURNS = b'\nState:\t', b'\nvoluntary_ctxt_switches:'


def tell_first(file: Path, number: int) -> None:
    """Write down the number of a controller's first process, from which all others come."""
    with replacing(file) as part:
        part.write_text(f'{number}\n', encoding='ascii')


class Resting:
    """
    Looks at the processes of a controller.

    :param first: the file that `tell_first` writes sooner or later.
    """

    def __init__(self, first: Path) -> None:
        self._first = first
        self._processes: list[int] = []
        self._look_again_sec = 0.0

    def at_rest(self) -> bool:
        """Return whether no thread has anything to do; False if there is no controller."""
        now_sec = time.monotonic()
        if now_sec >= self._look_again_sec:
            self._look_again_sec = now_sec + LOOK_FOR_SEC
            self._processes = _with_descendants(self._first)
        turns = _turns(self._processes)
        return turns is not None and turns == _turns(self._processes)


def _with_descendants(first: Path) -> list[int]:
    try:
        process = int(first.read_text(encoding='ascii'))
    except FileNotFoundError:  # not started yet
        return []
    return [process, *pids_below(process)]


def _turns(processes: Sequence[int]) -> dict[int, bytes] | None:
    """Return how often each thread has run; None if one is busy, or no process is left."""
    ours, is_left = os.getpid(), False
    turns: dict[int, bytes] = {}
    for process in (*processes, ours):
        for thread, state, count in _threads(process):
            if state in _ENDED or thread == threading.get_native_id():
                continue
            if state in _BUSY:
                return None
            turns[thread] = count
            is_left = is_left or process != ours
    return turns if is_left else None


def _threads(process: int) -> Iterator[tuple[int, bytes, bytes]]:
    """Yield of each thread of a process its number, its state and how often it has run."""
    try:
        with os.scandir(f'/proc/{process}/task') as threads:
            for thread in threads:
                file = os.open(f'{thread.path}/status', os.O_RDONLY)  # twice as fast as a Path
                try:
                    status = os.read(file, _STATUS_BYTES)
                finally:
                    os.close(file)
                state = status.index(_STATE) + len(_STATE)
                yield int(thread.name), status[state : state + 1], status[status.index(_TURNS) :]
    except (FileNotFoundError, ProcessLookupError, PermissionError):
        pass  # ended meanwhile, or hidden, as /proc may be mounted (hidepid)
