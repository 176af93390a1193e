# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The program that `ros2 run` starts, and waits for."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
import ctypes
import os
from pathlib import Path
import re
import signal
import subprocess

from interrupt_while_loading import takes_blocked_interrupt, words_of

_PASSED_ON = {
    *(signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT),
    *(signal.SIGUSR1, signal.SIGUSR2),
}
_PR_SET_PDEATHSIG = 1  # linux/prctl.h


def run(command: Sequence[str]) -> int:
    """Run a program to its end; return its exit status, or -N where signal N ended it.

    The program gets each signal once, whether it was sent to this process, to the group of both
    or by the terminal. Where this process is killed, the program is.

    :raises OSError: it cannot be started.
    """
    awaited = {*_PASSED_ON, signal.SIGCHLD}
    before = signal.pthread_sigmask(signal.SIG_BLOCK, awaited)
    # Before the program, which may be sent a signal as soon as it is there.
    witness = Witness()
    try:
        mask = {*before, signal.SIGINT} if takes_blocked_interrupt(command[0]) else before
        process = subprocess.Popen(words_of(command), preexec_fn=_program_of(witness, mask))
        while process.poll() is None:
            number = signal.sigwait(awaited)
            if number == signal.SIGCHLD:
                continue
            if witness.has(number):
                witness.end()
                witness = Witness()
            else:
                process.send_signal(number)
        return process.returncode
    finally:
        witness.end()
        while signal.sigtimedwait(awaited, 0) is not None:
            pass  # what came while the program ended was meant for it
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class Witness:
    """A process that only tells of a signal whether all of the group got it, as for Ctrl-C.

    It has the signals blocked that its maker has, so that each stays with it.
    """

    def __init__(self) -> None:
        bind = _bound_to_this(signal.pthread_sigmask(signal.SIG_BLOCK, ()))
        self._pid = os.fork()
        if self._pid == 0:
            try:
                bind()
                while True:
                    signal.pause()
            finally:
                os._exit(1)

    def has(self, number: int) -> bool:
        status = Path(f'/proc/{self._pid}/status').read_text()
        (pending,) = re.findall(r'ShdPnd:\s*(\w+)', status)
        return bool(int(pending, 16) >> (number - 1) & 1)

    def end(self) -> None:
        os.kill(self._pid, signal.SIGKILL)
        os.waitpid(self._pid, 0)


def _program_of(witness: Witness, mask: Collection[int]) -> Callable[[], None]:
    """Return what the program does first: take what the group was sent before it was there."""
    bind = _bound_to_this(mask)

    def prepare() -> None:
        for number in filter(witness.has, _PASSED_ON):
            os.kill(os.getpid(), number)  # blocked yet: what it has got already stays one
        bind()

    return prepare


def _bound_to_this(mask: Collection[int]) -> Callable[[], None]:
    """Return what a new process does first: die when this one does, and take a signal mask."""
    libc = ctypes.CDLL(None)
    parent = os.getpid()

    def prepare() -> None:
        libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)

    return prepare
