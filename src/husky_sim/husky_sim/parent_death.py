# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ends a process together with the one that started it, even where that one is killed hard."""

import ctypes
import sys

_PR_SET_PDEATHSIG = 1  # linux/prctl.h


def die_with_parent(signal_number: int) -> None:
    """
    Let the kernel send this process a signal when its parent ends; on Linux, elsewhere nothing.

    Strictly, when the thread ends that started it (prctl(2), PR_SET_PDEATHSIG). A parent that was
    gone before is not noticed.
    """
    if sys.platform == 'linux':
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal_number, 0, 0, 0)
