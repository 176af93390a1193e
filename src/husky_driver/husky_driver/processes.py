# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Children that are ended with everything they started.

A child gets a session of its own, so that its signals reach all of it, and dies with its parent
however that one ends. What leaves its session is found all the same, by a mark in its environment:
on Linux a process whose parent has ended is given to the next ancestor that asked for such
(`adopt_orphans`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import contextlib
import ctypes
from functools import partial
import os
from pathlib import Path
import signal
import subprocess
import sys
from types import FrameType
from typing import IO
from uuid import uuid4

from husky_sim.parent_death import die_with_parent
from husky_sim.shared_memory import clean_shared_memory
import psutil

END_WITHIN_SEC = 1.2  # of what is asked to end by SIGINT; Ctrl-C must be done in 2 s
FIRM_SEC = 0.4  # the same by SIGTERM
POLL_SEC = 0.02

_MARK = 'PLAYPEN_PROCESS'
_PR_SET_CHILD_SUBREAPER = 36  # linux/prctl.h


class Process:
    """
    A child in a session of its own.

    :param log: takes what it prints; None: what this process prints goes there too.
    :param answers: what it reads from its standard input.
    :param parent_death: the signal that it gets when its parent, the thread that starts it, ends.
    """

    def __init__(
        self,
        command: Sequence[str],
        environment: Mapping[str, str],
        log: IO[str] | None = None,
        answers: str = '',
        *,
        parent_death: int = signal.SIGTERM,
    ) -> None:
        """
        Start it.

        :raises OSError: if the command cannot be run.
        """
        self._mark = uuid4().hex
        self._child = subprocess.Popen(
            command,
            env={**environment, _MARK: self._mark},
            stdin=subprocess.PIPE if answers else subprocess.DEVNULL,
            stdout=log,
            stderr=None if log is None else subprocess.STDOUT,
            start_new_session=True,
            text=True,
            preexec_fn=partial(die_with_parent, parent_death),
        )
        if self._child.stdin is not None:
            with contextlib.suppress(BrokenPipeError):  # it does not listen; that is its business
                self._child.stdin.write(answers)
                self._child.stdin.close()

    @property
    def pid(self) -> int:
        return self._child.pid

    @property
    def exit_code(self) -> int | None:
        return self._child.poll()

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    def wait(self, timeout_sec: float) -> bool:
        """Wait for its end, at most so long; tell whether it has ended."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._child.wait(timeout_sec)
        return self._child.returncode is not None

    def signal(self, number: int) -> None:
        """Send a signal to all of its session."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._child.pid, number)

    def end(self, *, asked: bool = False) -> None:
        """
        End it with everything it started: kindly, firmly, then at once.

        :param asked: it has been asked kindly before.
        """
        if not asked:
            self.signal(signal.SIGINT)
            self.wait(END_WITHIN_SEC)
        for number in (signal.SIGTERM, signal.SIGKILL):
            if self.exit_code is None:
                self.signal(number)
                self.wait(FIRM_SEC)
        end_processes([each for each in _descendants() if _mark_of(each) == self._mark])


def _descendants() -> list[psutil.Process]:
    return list(psutil.Process().children(recursive=True))


def _mark_of(process: psutil.Process) -> str:
    try:
        return str(process.environ().get(_MARK, ''))
    except psutil.Error:  # it has ended, or is somebody else's
        return ''


def adopt_orphans() -> None:
    """Become the parent of every descendant that loses its own; on Linux only."""
    if sys.platform == 'linux':
        ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


@contextlib.contextmanager
def descendants_ended() -> Iterator[None]:
    """End every descendant that came meanwhile, also one that has lost its mark."""
    adopt_orphans()
    before = _descendants()
    try:
        yield
    finally:
        end_processes([each for each in _descendants() if each not in before])


def end_processes(processes: list[psutil.Process]) -> None:
    """End processes that should have ended by themselves: firmly, then at once."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        for process in processes:
            with contextlib.suppress(psutil.NoSuchProcess):
                process.send_signal(number)
        _, processes = psutil.wait_procs(processes, timeout=FIRM_SEC)


def run_to_end(command: Sequence[str], environment: Mapping[str, str]) -> int:
    """
    Run a command until it ends, and everything that it has started with it.

    Signals that ask this process to end are handed on.

    :returns: its exit status; minus the number of the signal that ended it.
    :raises SystemExit: when a signal has asked this process to end, with 128 and its number.
    """
    adopt_orphans()
    asked: list[int] = []
    with Process(command, environment) as child:

        def hand_on(number: int, _frame: FrameType | None) -> None:
            asked.append(number)
            child.signal(signal.SIGTERM if number == signal.SIGHUP else number)

        numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
        before = {number: signal.signal(number, hand_on) for number in numbers}
        try:
            while not asked and not child.wait(POLL_SEC):
                pass
            if asked:
                child.wait(END_WITHIN_SEC)
        finally:
            child.end(asked=bool(asked))
            end_processes(_descendants())
            clean_shared_memory()
            for number, handler in before.items():
                signal.signal(number, handler)
    if asked:
        print('\ninterrupted', file=sys.stderr)
        raise SystemExit(128 + asked[0])
    return child.exit_code or 0


def tail_of(path: Path, lines: int) -> str:
    try:
        text = path.read_text(encoding='utf-8', errors='replace').strip()
    except OSError:
        return ''
    return '\n'.join(text.splitlines()[-lines:])
