# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What runs the programs of a submission: the one door between them and the grader."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
import os
from pathlib import Path
import signal
from typing import Protocol

from husky_runtime.children import ChildProcess
from husky_runtime.descendants import descendants_ended


class Program(Protocol):
    """A program that was started."""

    @property
    def exit_code(self) -> int | None:
        """Its exit status, minus the number of the signal that ended it; None while it runs."""


class Runner(Protocol):
    """Runs programs of a submission; what they print goes to a log that is not theirs."""

    @property
    def folder(self) -> Path:
        """The folder that its programs may write to; the workspace is built there."""

    @property
    def environment(self) -> Mapping[str, str]:
        """The environment variables that its programs begin with."""

    def run(
        self, command: Sequence[str], environment: Mapping[str, str], log: Path, within_sec: float
    ) -> int | None:
        """
        Run a program, and end all that it has started; None: it took too long.

        :raises OSError: when it cannot be started.
        """

    def start(
        self, command: Sequence[str], environment: Mapping[str, str], log: Path, input: str = ''
    ) -> AbstractContextManager[Program]:
        """
        Return the context in which a program runs; its end ends all that this has started.

        :param input: what it reads from its standard input.
        :raises OSError: on entering, when it cannot be started.
        """


class HostRunner:
    """Runs programs as the grader itself: with its rights, its files and its network."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.environment: Mapping[str, str] = os.environ
        folder.mkdir(parents=True, exist_ok=True)

    def run(
        self, command: Sequence[str], environment: Mapping[str, str], log: Path, within_sec: float
    ) -> int | None:
        with self.start(command, environment, log) as process:
            return process.exit_code if process.wait(within_sec) else None

    @contextmanager
    def start(
        self, command: Sequence[str], environment: Mapping[str, str], log: Path, input: str = ''
    ) -> Iterator[ChildProcess]:
        with (
            descendants_ended(),
            log.open('w') as stream,
            ChildProcess(
                command, environment, stream, input, parent_death=signal.SIGKILL
            ) as process,
        ):
            yield process
