# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Child processes that are ended with everything they started.

A child gets a session of its own, so that its signals reach all of it, and dies with its parent
however that one ends. What leaves its session carries the child's mark; see `descendants`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import contextlib
from functools import partial
import os
from pathlib import Path
import select
import signal
import subprocess
import time
from typing import IO
from uuid import uuid4
import weakref

import psutil

from husky_runtime.descendants import (
    descendants,
    end_processes,
    FIRM_SEC,
    HURRIED_FIRM_SEC,
    MARK,
)
from husky_runtime.parent_death import die_with_parent

END_WITHIN_SEC = 1.2  # from SIGINT to SIGTERM
# The same after Ctrl-C, which must be done in 2 s: with two children in a row, with what these
# have started, and with their shared memory.
HURRIED_SEC = 0.4


class ChildProcess:
    """
    A child in a session of its own; a context manager that ends it.

    :param log: takes what it prints; None: what this process prints goes there too.
    :param answers: what it reads from its standard input.
    :param reads: it has the standard input of this process instead, as a debugger needs.
    :param parent_death: the signal that it gets when its parent, the thread that starts it, ends.
    :param inherited: numbers of open files that it gets besides, as they are here.
    """

    def __init__(
        self,
        command: Sequence[str],
        environment: Mapping[str, str],
        log: IO[str] | None = None,
        answers: str = '',
        *,
        reads: bool = False,
        parent_death: int = signal.SIGTERM,
        inherited: Sequence[int] = (),
    ) -> None:
        """
        Start it.

        :raises OSError: if the command cannot be run.
        """
        self._mark = uuid4().hex
        self._child = subprocess.Popen(
            command,
            env={**environment, MARK: self._mark},
            stdin=subprocess.PIPE if answers else None if reads else subprocess.DEVNULL,
            stdout=log,
            stderr=None if log is None else subprocess.STDOUT,
            start_new_session=True,
            text=True,
            preexec_fn=partial(die_with_parent, parent_death),
            pass_fds=inherited,
        )
        self._end = _watched_end(self, self._child.pid)
        if self._child.stdin is not None:
            with contextlib.suppress(BrokenPipeError):  # it does not read its input
                self._child.stdin.write(answers)
                self._child.stdin.close()

    @property
    def pid(self) -> int:
        return self._child.pid

    @property
    def exit_code(self) -> int | None:
        """Its exit status, minus the number of the signal that ended it; None while it runs."""
        return self._child.poll()

    def __enter__(self) -> ChildProcess:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is KeyboardInterrupt:
            self.end(within_sec=HURRIED_SEC, firm_sec=HURRIED_FIRM_SEC)
        else:
            self.end()

    def wait(self, timeout_sec: float) -> bool:
        """Wait for its end, at most so long; tell whether it has ended."""
        if self._end is not None:
            end = select.poll()  # one for each thread that waits
            end.register(self._end, select.POLLIN)
            end.poll(max(timeout_sec, 0.0) * 1000)  # below 0 it would wait for ever
            return self.exit_code is not None
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
        End it with everything it started; may be called twice.

        :param by: the first signal.
        :param within_sec: how long to wait after it, before SIGTERM.
        :param firm_sec: how long to wait after SIGTERM, before SIGKILL.
        """
        for number, wait_sec in (
            (by, within_sec),
            (signal.SIGTERM, firm_sec),
            (signal.SIGKILL, firm_sec),
        ):
            if self.exit_code is None:
                self._end_group(number, wait_sec)
        end_processes(descendants(mark=self._mark), firm_sec=firm_sec)

    def _end_group(self, number: int, wait_sec: float) -> None:
        """
        Send a signal to all of its session, and wait for their end, at most so long.

        A launch of Jazzy's ends at once on SIGTERM; the nodes it has started may need longer.
        """
        deadline_sec = time.monotonic() + wait_sec
        others = [each for each in descendants(mark=self._mark) if self._has_in_group(each.pid)]
        self.send(number)
        if self.wait(wait_sec):
            psutil.wait_procs(others, timeout=max(deadline_sec - time.monotonic(), 0.0))

    def _has_in_group(self, pid: int) -> bool:
        try:
            return pid != self.pid == os.getpgid(pid)
        except ProcessLookupError:
            return False


def _watched_end(owner: object, pid: int) -> int | None:
    """
    Return a file that can be read when a process has ended, closed with its owner.

    None where the kernel has no such thing. Popen.wait asks again and again for as long as it may
    wait, which takes a hundredth of a processor's time.
    """
    try:
        file = os.pidfd_open(pid)
    except (AttributeError, OSError):
        return None
    weakref.finalize(owner, os.close, file)
    return file


def tail_of(path: Path, lines: int) -> str:
    """Return the last lines of a file; nothing if it cannot be read."""
    try:
        text = path.read_text(encoding='utf-8', errors='replace').strip()
    except OSError:
        return ''
    return '\n'.join(text.splitlines()[-lines:])
