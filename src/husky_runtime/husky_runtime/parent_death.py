# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
End with the process that started this one, however that one ends.

As a program, `parent_death.py COMMAND...` runs a command that does so.
"""

import ctypes
import os
import signal
import sys

_PR_SET_PDEATHSIG = 1  # linux/prctl.h

# Loaded here: between fork and exec of a process with threads little is allowed.
_LIBC = ctypes.CDLL(None) if sys.platform == 'linux' else None


def die_with_parent(signal_number: int) -> None:
    """
    Have the kernel send this process a signal when its parent ends; on Linux only.

    The parent is the thread that started this process: one that ends early sends it early.
    """
    if _LIBC is not None:
        _LIBC.prctl(_PR_SET_PDEATHSIG, signal_number, 0, 0, 0)


if __name__ == '__main__':
    die_with_parent(signal.SIGTERM)
    os.execvp(sys.argv[1], sys.argv[1:])
