# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A terminal with a shell, into which a test types as a person does."""

import signal

from playpen_testing.processes import Process, Processes
from playpen_testing.waiting import wait_until

_DONE = '@@ done with'


class Terminal:
    """A shell that is typed into; what stands in it is read line by line."""

    def __init__(self, processes: Processes) -> None:
        self._shell: Process = processes.start('bash', '--noprofile', '--norc')
        # Ctrl-C ends what runs in the terminal, not the terminal.
        self._shell.write('trap : INT\n')
        self._typed = 0
        self._first_line = 0

    @property
    def screen(self) -> str:
        """Return what has come since the last command was typed, without our own marks."""
        lines = self._shell.lines[self._first_line :]
        return '\n'.join(line for line in lines if not line.startswith(_DONE))

    @property
    def busy(self) -> bool:
        return self._typed > 0 and not self._is_done()

    @property
    def statuses(self) -> list[int]:
        """Return the exit status of every block that was typed and has ended."""
        return [int(line.split()[-1]) for line in self._shell.lines if line.startswith(_DONE)]

    def type(self, commands: str) -> None:
        """Type commands; what still runs is ended by Ctrl-C first, as a person must."""
        if self.busy:
            self.interrupt()
        self._first_line = len(self._shell.lines)
        self._typed += 1
        mark = f'status=$?; echo; echo "{_DONE} {self._typed} $status"'
        self._shell.write(f'{commands.rstrip()}\n{mark}\n')

    def interrupt(self, *, timeout_sec: float = 15.0) -> None:
        """Press Ctrl-C and wait until the shell is back."""
        self._shell.signal(signal.SIGINT)
        self.wait_until_done(timeout_sec=timeout_sec)

    def close(self) -> None:
        """End what runs in it, then the shell; may be called twice."""
        if self._shell.returncode is None:
            self._shell.signal(signal.SIGINT)
            self._shell.write('exit\n')

    def wait_until_done(self, *, timeout_sec: float) -> None:
        wait_until(
            lambda: not self.busy,
            timeout_sec=timeout_sec,
            what=lambda: f'the end of the command in the terminal, which shows:\n{self.screen}',
        )

    def _is_done(self) -> bool:
        mark = f'{_DONE} {self._typed} '
        return any(line.startswith(mark) for line in self._shell.lines[self._first_line :])
