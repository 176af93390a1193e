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
from typing import IO
from uuid import uuid4

import psutil

from husky_runtime.parent_death import die_with_parent
from husky_runtime.shared_memory import clean_shared_memory

END_WITHIN_SEC = 1.2  # of what is asked to end by SIGINT, when nobody waits for it
FIRM_SEC = 0.4  # the same by SIGTERM
# The same after Ctrl-C, which must be done in 2 s: with two children in a row, with what these
# have started, and with their shared memory.
HURRIED_SEC = 0.4
HURRIED_FIRM_SEC = 0.2
RUN_ENDS_WITHIN_SEC = 1.0  # of the one child of a run, which has a record to close
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

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is KeyboardInterrupt:
            self.end(within_sec=HURRIED_SEC, firm_sec=HURRIED_FIRM_SEC)
        else:
            self.end()

    def wait(self, timeout_sec: float) -> bool:
        """Wait for its end, at most so long; tell whether it has ended."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._child.wait(timeout_sec)
        return self._child.returncode is not None

    def send(self, number: int) -> None:
        """Send a signal to all of its session."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._child.pid, number)

    def end(
        self,
        by: int = signal.SIGINT,
        *,
        within_sec: float = END_WITHIN_SEC,
        firm_sec: float = FIRM_SEC,
    ) -> None:
        """
        End it with everything it started: kindly, firmly, then at once.

        :param by: the kind signal.
        :param within_sec: how long it may take to end then.
        :param firm_sec: how long it may take after SIGTERM.
        """
        for number, wait_sec in (
            (by, within_sec),
            (signal.SIGTERM, firm_sec),
            (signal.SIGKILL, firm_sec),
        ):
            if self.exit_code is None:
                self.send(number)
                self.wait(wait_sec)
        mine = [each for each in _descendants() if _mark_of(each) == self._mark]
        end_processes(mine, firm_sec=firm_sec)


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
    firm_sec = FIRM_SEC
    try:
        yield
    except KeyboardInterrupt:
        firm_sec = HURRIED_FIRM_SEC
        raise
    finally:
        came = [each for each in _descendants() if each not in before]
        end_processes(came, firm_sec=firm_sec)


def end_processes(processes: list[psutil.Process], *, firm_sec: float) -> None:
    """End processes that should have ended by themselves: firmly, then at once."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        for process in processes:
            with contextlib.suppress(psutil.NoSuchProcess):
                process.send_signal(number)
        _, processes = psutil.wait_procs(processes, timeout=firm_sec)


def run_to_end(command: Sequence[str], environment: Mapping[str, str]) -> int:
    """
    Run a command until it ends, and everything that it has started with it.

    :returns: its exit status; minus the number of the signal that ended it.
    :raises SystemExit: when a signal has asked this process to end, with 128 and its number.
    """
    adopt_orphans()
    asked: list[int] = []
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = {
        number: signal.signal(number, lambda number, _: asked.append(number)) for number in numbers
    }
    firm_sec = FIRM_SEC
    try:
        child = Process(command, environment)
        while not asked and not child.wait(POLL_SEC):
            pass
        if asked:
            firm_sec = HURRIED_FIRM_SEC
        kind = signal.SIGINT if signal.SIGINT in asked else signal.SIGTERM
        child.end(kind, within_sec=RUN_ENDS_WITHIN_SEC, firm_sec=firm_sec)
    finally:
        end_processes(_descendants(), firm_sec=firm_sec)
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
