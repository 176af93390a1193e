# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A process in a jail, watched by a thread: what it prints is kept, what it uses is limited."""

from __future__ import annotations

import contextlib
from dataclasses import replace
import os
from pathlib import Path
import select
import signal
import threading
import time

from husky_runtime.children import ChildProcess
from husky_runtime.descendants import pids_below
import psutil

from husky_grader.jail.limits import MB
from husky_grader.jail.log import Log
from husky_grader.jail.sandbox import Call, Cell
from husky_grader.jail.usage import PROCESSES_SEC, Usage

END_WITHIN_SEC = 1.0  # from a signal to the end of everything
_KILLED_WITHIN_SEC = 5.0  # what takes longer hangs in the kernel
_CHUNK_BYTES = 1 << 16


class JailedProcess:
    """
    A command in a jail, with the interface of ChildProcess; a context manager that ends it.

    It has ended when nothing that it started is left, and its log is complete.

    :param log: the file for what it prints.
    :param answers: what it reads from its standard input.
    """

    def __init__(self, cell: Cell, call: Call, *, log: Path, answers: str = '') -> None:
        """
        Start it.

        :raises OSError: if the log cannot be written.
        """
        self._usage = Usage(call.folder, call.limits)
        self.stopped = ''  # in words, which limit ended it
        with contextlib.ExitStack() as opened:
            self._log = opened.enter_context(Log(log, int(call.limits.log_mb * MB)))
            reader, writer = os.pipe()
            # What select has seen may be gone: a program can open its output, and read it too.
            os.set_blocking(reader, False)
            self._printed = opened.enter_context(os.fdopen(reader, 'rb', buffering=0))
            reader, held = os.pipe()
            opened.callback(os.close, held)
            with os.fdopen(writer, 'w') as output, os.fdopen(reader, 'rb') as lifeline:
                self._entry = cell.enter(replace(call, lifeline=lifeline.fileno()))
                self._child = ChildProcess(
                    self._entry.command,
                    self._entry.environment,
                    output,
                    answers,
                    parent_death=signal.SIGKILL,
                    inherited=[lifeline.fileno()] if self._entry.takes_lifeline else [],
                )
            self._opened = opened.pop_all()
        self._watch = threading.Thread(target=self._keep_watch, daemon=True)
        self._watch.start()

    @property
    def pid(self) -> int:
        return self._child.pid

    @property
    def first_pid(self) -> int | None:
        """The number of the process from which all others come; None if it is not there."""
        first = self._first()
        return first.pid if first else None

    @property
    def exit_code(self) -> int | None:
        """Its exit status, minus the number of the signal that ended it; None while it runs."""
        if self._watch.is_alive():
            return None
        code = self._child.exit_code
        # inside.py says it as a shell does: 128 and the number.
        if code is not None and code - 128 in signal.valid_signals():
            return 128 - code
        return code

    def __enter__(self) -> JailedProcess:
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    def wait(self, timeout_sec: float) -> bool:
        """Wait for its end, at most so long; tell whether it has ended."""
        self._watch.join(timeout_sec)
        return not self._watch.is_alive()

    def end(self, by: int = signal.SIGINT, *, within_sec: float = END_WITHIN_SEC) -> None:
        """
        End it with everything it started; may be called twice.

        :param by: the first signal.
        :param within_sec: how long to wait after it before all is killed.
        """
        for pid in self._pids():
            with contextlib.suppress(psutil.NoSuchProcess):
                psutil.Process(pid).send_signal(by)
        self.wait(within_sec)
        self.kill()

    def kill(self) -> None:
        """End it with everything it started at once; may be called twice."""
        self._kill()
        self._watch.join(_KILLED_WITHIN_SEC)

    def _kill(self) -> None:
        deadline_sec = time.monotonic() + _KILLED_WITHIN_SEC
        # Not the child: it ends by itself when all else has ended.
        while self._entry.first and self._child.exit_code is None:
            if first := self._entry.first(self._child):
                with contextlib.suppress(psutil.NoSuchProcess):
                    first.kill()
            if self._child.wait(0.05) or time.monotonic() > deadline_sec:
                break
        self._child.end(signal.SIGKILL)

    def _pids(self) -> list[int]:
        """Return all that run the command; not who put it into the jail, if that is another."""
        if self._entry.is_first_elsewhere:
            first = self._first()
            return [first.pid, *pids_below(first.pid)] if first else []
        within = pids_below(self._child.pid)
        return within if self._entry.first else [self._child.pid, *within]

    def _first(self) -> psutil.Process | None:
        if self._entry.first is not None:
            return self._entry.first(self._child)
        with contextlib.suppress(psutil.NoSuchProcess):
            return psutil.Process(self._child.pid)
        return None

    def _keep_watch(self) -> None:
        """Keep what is printed, and hold what is used to its limits, until all has ended."""
        is_open = True
        with self._opened:
            while True:
                has_ended = self._child.exit_code is not None
                wait_sec = 0.0 if has_ended else PROCESSES_SEC
                if is_open and select.select([self._printed], [], [], wait_sec)[0]:
                    text = self._printed.read(_CHUNK_BYTES)
                    if text is not None:  # else the program itself was faster
                        self._log.add(text)
                        is_open = bool(text)
                elif has_ended:
                    break
                elif not is_open:
                    self._child.wait(wait_sec)
                self._log.show()
                if not has_ended and (why := self._usage.too_much(self._pids)):
                    self.stopped = why
                    self._kill()
            if self.stopped:
                self._log.note(f'ended by the grader: it {self.stopped}')
