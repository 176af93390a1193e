# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The keys of the terminal in which a bag is played or recorded."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
import os
import select
import signal
import sys
import termios
import tty
from types import FrameType
from typing import Any

# What a terminal sends, by upstream's names of the keys.
_SENT = {
    'SPACE': b' ',
    'CURSOR_UP': b'\x1b[A',
    'CURSOR_DOWN': b'\x1b[B',
    'CURSOR_RIGHT': b'\x1b[C',
}


class Keyboard:
    """Calls what the pressed keys are for; without a terminal none is pressed.

    :param actions: what to call, by the names of the keys.
    """

    def __init__(self, actions: dict[str, Callable[[], Any]]) -> None:
        self._actions = {_SENT[key]: act for key, act in actions.items()}
        self._terminal = sys.stdin.fileno() if actions and sys.stdin.isatty() else None
        self._before: list[Any] | None = None  # the settings that `restore` puts back

    @property
    def is_there(self) -> bool:
        return self._terminal is not None

    def serve(self) -> None:
        """Do what has been pressed since the last time, without waiting."""
        if self._terminal is None or not _is_ours(self._terminal):
            return
        try:
            pressed = self._read(self._terminal)
        except (OSError, termios.error):  # it was closed
            self._terminal = None
            return
        while pressed:
            key = next((key for key in self._actions if pressed.startswith(key)), b'')
            if key:
                self._actions[key]()
            pressed = pressed[len(key) or 1 :]

    def _read(self, terminal: int) -> bytes:
        if self._before is None:
            self._before = termios.tcgetattr(terminal)
            tty.setcbreak(terminal, termios.TCSANOW)
        return os.read(terminal, 1024) if select.select([terminal], [], [], 0.0)[0] else b''

    def restore(self) -> None:
        """Give the terminal back as it was; may be called twice."""
        if self._terminal is not None and self._before is not None:
            with suppress(termios.error):  # it may be closed
                termios.tcsetattr(self._terminal, termios.TCSANOW, self._before)
            self._before = None

    def stop(self, number: int, frame: FrameType | None) -> None:
        """Stop as for Ctrl-Z: the shell that comes back gets its terminal as it was."""
        del frame
        self.restore()
        handler = signal.signal(number, signal.SIG_DFL)
        signal.raise_signal(number)
        signal.signal(number, handler)


@contextmanager
def controls(actions: dict[str, Callable[[], Any]], *, disabled: bool) -> Iterator[Keyboard]:
    """Give the keyboard for the time of a command, and the terminal back at its end."""
    keyboard = Keyboard({} if disabled else actions)
    before = signal.getsignal(signal.SIGTSTP)
    if before == signal.SIG_DFL:  # where it is ignored there is nobody to come back to
        signal.signal(signal.SIGTSTP, keyboard.stop)
    try:
        yield keyboard
    finally:
        keyboard.restore()
        signal.signal(signal.SIGTSTP, before)


def _is_ours(terminal: int) -> bool:
    """Tell whether a program may read from its terminal: in the background that stops it."""
    try:
        return os.tcgetpgrp(terminal) == os.getpgrp()
    except OSError:  # the terminal of somebody else, without jobs
        return True
