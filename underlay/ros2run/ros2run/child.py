# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The program that `ros2 run` starts, and waits for."""

from __future__ import annotations

from collections.abc import Collection, Sequence
import ctypes
import os
import signal
import subprocess

from interrupt_while_loading import takes_blocked_interrupt

_PASSED_ON = {signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT}
_PR_SET_PDEATHSIG = 1  # linux/prctl.h


def run(command: Sequence[str]) -> int:
    """Run a program to its end; return its exit status, or -N where signal N ended it.

    A signal that this process gets goes to the program; one of the terminal has reached it by
    itself. Where this process is killed, the program is.

    :raises OSError: it cannot be started.
    """
    awaited = {*_PASSED_ON, signal.SIGCHLD}
    before = signal.pthread_sigmask(signal.SIG_BLOCK, awaited)
    try:
        mask = {*before, signal.SIGINT} if takes_blocked_interrupt(command[0]) else before
        process = _start(command, mask)
        while process.poll() is None:
            told = signal.sigwaitinfo(awaited)
            # sigaction(2): a code above 0 is the kernel's, as for Ctrl-C in the group of both.
            if told.si_signo != signal.SIGCHLD and told.si_code <= 0:
                process.send_signal(told.si_signo)
        return process.returncode
    finally:
        while signal.sigtimedwait(awaited, 0) is not None:
            pass  # what came while the program ended was meant for it
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _start(command: Sequence[str], mask: Collection[int]) -> subprocess.Popen[bytes]:
    libc = ctypes.CDLL(None)
    parent = os.getpid()

    def prepare() -> None:
        libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)

    return subprocess.Popen(command, preexec_fn=prepare)
