# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Start real processes, read what they print, and end them all."""

from collections.abc import Iterable, Sequence
import contextlib
from functools import partial
import os
from pathlib import Path
import re
import signal
import subprocess
import threading
import time
from typing import Any, IO

from husky_runtime.parent_death import die_with_parent

from playpen_testing.fast_dds import without_port_race
from playpen_testing.waiting import wait_until

IN_A_TERMINAL = 'import os, pty, sys; sys.exit(os.waitstatus_to_exitcode(pty.spawn(sys.argv[1:])))'
"""A program for `python3 -c` that runs a command in a terminal."""


def find_line(output: Iterable[str], pattern: str) -> re.Match[str]:
    """
    Read on to the first line in which a pattern is found; return the match.

    Fast DDS may print a harmless line of its own before the one that a test waits for.
    """
    before = ''
    for line in output:
        found = re.search(pattern, line)
        if found is not None:
            return found
        before += line
    raise AssertionError(f'the output ended without {pattern!r}:\n{before}')


class Child(subprocess.Popen[str]):
    """
    A process whose output may be read line by line, and then to its end.

    The communicate() of subprocess loses what was read ahead with the last line.
    """

    def __init__(self, command: Sequence[str], **options: Any) -> None:
        super().__init__(command, text=True, **options)
        self._rests: list[list[str]] = [[], []]
        self._readers: list[threading.Thread] = []

    def communicate(
        self, given: str | None = None, timeout: float | None = None
    ) -> tuple[str, str]:
        """
        Write the input, and return what is still to be read of stdout and stderr.

        :raises subprocess.TimeoutExpired: if it has not ended by then; may be called again.
        """
        end = None if timeout is None else time.monotonic() + timeout
        if not self._readers:
            for stream, rest in zip((self.stdout, self.stderr), self._rests, strict=True):
                if stream is not None and not stream.closed:
                    self._readers.append(threading.Thread(target=_read, args=(stream, rest)))
                    self._readers[-1].daemon = True
                    self._readers[-1].start()
            if self.stdin is not None:
                with contextlib.suppress(BrokenPipeError), self.stdin:
                    self.stdin.write(given or '')
        for reader in self._readers:
            reader.join(None if end is None else max(0.0, end - time.monotonic()))
            if reader.is_alive():
                assert timeout is not None
                raise subprocess.TimeoutExpired(self.args, timeout)
        self.wait(None if end is None else max(0.0, end - time.monotonic()))
        out, err = (without_port_race(''.join(rest)) for rest in self._rests)
        return out, err


def _read(stream: IO[str], rest: list[str]) -> None:
    with stream:
        rest.append(stream.read())


class Process:
    """
    A child in its own process group whose output is collected line by line.

    It ends with the thread that starts it, however that ends.
    """

    def __init__(
        self, command: Sequence[str], *, cwd: Path | None, environment: dict[str, str] | None
    ) -> None:
        self.command = list(command)
        self.lines: list[str] = []
        self.printed_sec: list[float] = []  # when each came, of the clock time.monotonic()
        self._child = subprocess.Popen(
            self.command,
            cwd=cwd,
            env={**os.environ, **(environment or {})},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            bufsize=1,
            start_new_session=True,
            preexec_fn=partial(die_with_parent, signal.SIGKILL),
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._child.stdout is not None
        for line in filter(without_port_race, self._child.stdout):
            self.printed_sec.append(time.monotonic())
            self.lines.append(line.rstrip('\n'))

    @property
    def output(self) -> str:
        return '\n'.join(self.lines)

    @property
    def pid(self) -> int:
        return self._child.pid

    @property
    def returncode(self) -> int | None:
        return self._child.poll()

    def write(self, text: str) -> None:
        """Type something into the child's standard input."""
        assert self._child.stdin is not None
        self._child.stdin.write(text)
        self._child.stdin.flush()

    def signal(self, number: signal.Signals) -> None:
        """Send a signal to the child's whole group, as a terminal does for Ctrl-C."""
        os.killpg(self._child.pid, number)

    def wait_for_text(self, text: str, *, timeout_sec: float = 20.0) -> None:
        """Return when some line printed holds the text."""
        wait_until(
            lambda: any(text in line for line in self.lines),
            timeout_sec=timeout_sec,
            what=lambda: f'{text!r} from {" ".join(self.command)}; it printed:\n{self.output}',
        )

    def wait(self, *, timeout_sec: float = 20.0) -> int:
        """Return the exit status once the child has ended and all its output is read."""
        wait_until(
            lambda: self.returncode is not None,
            timeout_sec=timeout_sec,
            what=lambda: f'the end of {" ".join(self.command)}; it printed:\n{self.output}',
        )
        self._reader.join(timeout=5.0)
        return self._child.wait()

    def close(self) -> str:
        """
        End the child's whole group, gently first; may be called twice.

        :returns: how it ended, in words.
        """
        before = self.returncode
        how = 'ran until here' if before is None else f'had ended with {before}'
        for number in (signal.SIGINT, signal.SIGKILL):
            try:
                os.killpg(self._child.pid, number)
            except ProcessLookupError:
                break
            try:
                self._child.wait(timeout=3.0)
            except subprocess.TimeoutExpired:
                how = 'did not heed Ctrl-C'
                continue
        self._child.wait()
        self._reader.join(timeout=5.0)
        for stream in (self._child.stdin, self._child.stdout):
            if stream is not None:
                stream.close()
        return how


class Processes:
    """The children of one test, closed in reverse; of a test that failed, pytest shows all."""

    def __init__(self) -> None:
        self._started: list[Process] = []

    def start(
        self,
        *command: str,
        cwd: Path | None = None,
        environment: dict[str, str] | None = None,
    ) -> Process:
        process = Process(command, cwd=cwd, environment=environment)
        self._started.append(process)
        return process

    def __enter__(self) -> 'Processes':
        return self

    def __exit__(self, *_: object) -> None:
        for process in reversed(self._started):
            how = process.close()
            print(f'{" ".join(process.command)} {how}; it printed:\n{process.output}')
