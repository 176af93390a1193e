# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""An end of the process at a time, whatever then holds Python's lock."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import ctypes

_SIGEV_THREAD, _CLOCK_MONOTONIC = 2, 1  # of Linux, as are the layouts below


class _SigEvent(ctypes.Structure):
    """The struct sigevent: sigevent(3type)."""

    _fields_ = [
        ('value', ctypes.c_void_p),
        ('signo', ctypes.c_int),
        ('notify', ctypes.c_int),
        ('function', ctypes.c_void_p),
        ('attributes', ctypes.c_void_p),
        ('padding', ctypes.c_char * 32),
    ]


class _TimerSpec(ctypes.Structure):
    """The struct itimerspec: timer_settime(2)."""

    _fields_ = [(name, ctypes.c_long) for name in ('every_sec', 'every_ns', 'sec', 'ns')]


@contextmanager
def exits_in(seconds: float, status: int) -> Iterator[None]:
    """End the process with a status where something takes longer.

    A thread of the kernel's timer calls `_exit`: nothing of Python has to run for that.
    """
    libc = ctypes.CDLL(None)
    if not hasattr(libc, 'timer_create'):  # glibc before 2.34
        libc = ctypes.CDLL('librt.so.1')
    leave = ctypes.cast(libc._exit, ctypes.c_void_p)
    event = _SigEvent(value=status, notify=_SIGEV_THREAD, function=leave.value)
    timer = ctypes.c_void_p()
    if libc.timer_create(_CLOCK_MONOTONIC, ctypes.byref(event), ctypes.byref(timer)) != 0:
        yield  # a process may have only so many timers
        return
    when = _TimerSpec(sec=int(seconds), ns=int(seconds % 1.0 * 1e9))
    libc.timer_settime(timer, 0, ctypes.byref(when), None)
    try:
        yield
    finally:
        libc.timer_delete(timer)
