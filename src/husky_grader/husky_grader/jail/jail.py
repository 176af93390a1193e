# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A jail: a folder, a network and processes of its own for the programs of somebody else."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, ExitStack
from pathlib import Path

from husky_grader.jail.folders import environment_for, give, home_of, mounts_of
from husky_grader.jail.limits import Limits
from husky_grader.jail.process import JailedProcess
from husky_grader.jail.sandbox import Call, Cell, Sandbox


class Jail:
    """
    Runs programs that nobody knows; a context manager that ends all of them.

    Each command has processes, /tmp and /dev/shm of its own. The folder and the network are those
    of the jail; the system and ROS can be read, and there is nothing else: not the lab's own
    packages either, because there are solutions among them.

    :param folder: what the programs may write, at the same path as outside; their home is in it.
    :param readable: files and folders that they may read besides.
    :param without: packages that are not there of the workspaces that the terminal has sourced.
    """

    def __init__(
        self,
        sandbox: Sandbox,
        folder: Path,
        *,
        readable: Iterable[Path] = (),
        without: Iterable[str] = (),
        limits: Limits = Limits(),  # noqa: B008  # frozen
    ) -> None:
        """
        Prepare it.

        :raises ValueError: if there is no such folder.
        """
        if not folder.is_dir():
            raise ValueError(f'{folder}: no such folder; make the one that the jail may write')
        self._sandbox, self._limits = sandbox, limits
        self._folder, self._readable = folder.resolve(), tuple(readable)
        self._without = tuple(without)

    def __enter__(self) -> Jail:
        with ExitStack() as stack:
            self._cell: Cell = stack.enter_context(self._sandbox.open())
            # To find them takes longer than to hear that a sandbox is not there.
            self._mounts = mounts_of(
                self._folder, self._readable, self._limits, without=self._without
            )
            home_of(self._folder).mkdir(exist_ok=True)
            if self._cell.user is not None:
                give(self._folder, self._cell.user)
            self._running = stack.enter_context(ExitStack())
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    @property
    def folder(self) -> Path:
        """What the programs may write."""
        return self._folder

    @property
    def graph(self) -> Mapping[str, str]:
        """The variables by which trusted nodes beside the jail and jailed ones find each other."""
        return self._cell.graph

    def start(
        self,
        command: Sequence[str],
        environment: Mapping[str, str] | None = None,
        *,
        log: Path,
        answers: str = '',
    ) -> JailedProcess:
        """
        Start a command in the folder; the jail ends it at last.

        :param environment: besides that of ROS, and nothing that others must not know.
        :param log: for what it prints; not in the folder.
        :param answers: what it reads from its standard input.
        :raises OSError: if the log cannot be written.
        """
        variables = environment_for(self._folder, environment or {}, without=self._without)
        process = JailedProcess(
            self._cell,
            Call(
                command=command,
                environment={**variables, **self.graph},
                folder=self._folder,
                mounts=self._mounts,
                limits=self._limits,
            ),
            log=log,
            answers=answers,
        )
        return self._running.enter_context(process)

    def run(
        self,
        command: Sequence[str],
        environment: Mapping[str, str] | None = None,
        *,
        log: Path,
        within_sec: float,
    ) -> int | None:
        """
        Run a command, and end all that it has started; see `start`.

        :returns: its exit code, minus the number of the signal that ended it; None: too late.
        """
        with self.started(command, environment, log=log) as process:
            return process.exit_code if process.wait(within_sec) else None

    @contextmanager
    def started(
        self,
        command: Sequence[str],
        environment: Mapping[str, str] | None = None,
        *,
        log: Path,
        answers: str = '',
    ) -> Iterator[JailedProcess]:
        """Start a command, and at the end of the context end all that it has started."""
        with (
            self._cell.ending_all(),
            self.start(command, environment, log=log, answers=answers) as process,
        ):
            yield process

    def beside(self, command: Sequence[str]) -> list[str]:
        """
        Return the command by which a trusted one runs outside, but in the jail's network.

        Give it the variables of `graph`; a ChildProcess of it ends with this process.
        """
        return self._cell.beside(command)
