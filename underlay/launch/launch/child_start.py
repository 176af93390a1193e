# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a child does between its fork and its program."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
import contextlib
import ctypes
import os
import shutil
import signal
import sys

from interrupt_while_loading import takes_blocked_interrupt

_PR_SET_PDEATHSIG = 1  # linux/prctl.h
_ORPHANED_STATUS = 128 + signal.SIGTERM


@contextlib.contextmanager
def interrupts_held_back() -> Iterator[None]:
    """Let no interrupt meet a child before its program does; it would be lost there.

    Several of these may overlap in one asyncio loop, for none forks after the first wait.
    """
    signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))


def preparation(cmd: Sequence[str], *, shell: bool) -> Callable[[], None]:
    """Return what the child calls before it becomes the command.

    It ends when the launch ends, also when that is killed. Upstream leaves it running. Where
    Python takes the signal later, an interrupt stays held back.
    """
    program = None if shell else shutil.which(cmd[0])
    holds_back = program is not None and takes_blocked_interrupt(program)
    prctl = ctypes.CDLL(None).prctl if sys.platform == 'linux' else None
    parent = os.getpid()

    def prepare() -> None:
        if prctl is not None:
            prctl(_PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
            if os.getppid() != parent:
                os._exit(_ORPHANED_STATUS)
        if not holds_back:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))

    return prepare
