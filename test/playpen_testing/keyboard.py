# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The keys of a real terminal in which a command runs."""

from __future__ import annotations

from contextlib import suppress
import os
import signal
import subprocess
import termios

from playpen_testing.fast_dds import without_port_race
from playpen_testing.waiting import wait_until

UP, DOWN, RIGHT, LEFT = (f'\x1b[{letter}' for letter in 'ABCD')
CTRL_C, CTRL_Z = '\x03', '\x1a'


class Keyboard:
    """A terminal in which a command runs."""

    def __init__(self, *command: str) -> None:
        self._master, self._slave = os.openpty()
        self.before = termios.tcgetattr(self._slave)
        self.shown = ''
        self.process = subprocess.Popen(
            ['setsid', '--ctty', '--wait', *command],
            stdin=self._slave,
            stdout=self._slave,
            stderr=self._slave,
        )
        os.set_blocking(self._master, False)

    def press(self, keys: str) -> None:
        os.write(self._master, keys.encode())

    def wait_for_text(self, text: str) -> None:
        def comes() -> bool:
            with suppress(BlockingIOError):
                self.shown += os.read(self._master, 4096).decode()
                self.shown = without_port_race(self.shown)
            return text in self.shown

        wait_until(comes, timeout_sec=20.0, what=lambda: f'{text!r} in {self.shown!r}')

    def send_signal(self, number: signal.Signals) -> None:
        """Send a signal to what runs in the foreground."""
        os.killpg(os.tcgetpgrp(self._master), number)

    def is_as_before(self) -> bool:
        return termios.tcgetattr(self._slave) == self.before

    def put_back(self) -> None:
        """Put the terminal back as it was before the command."""
        termios.tcsetattr(self._slave, termios.TCSADRAIN, self.before)

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        os.close(self._master)
        os.close(self._slave)
