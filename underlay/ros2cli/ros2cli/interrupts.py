# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""SIGINT in a job that a script has started in the background."""

from __future__ import annotations

import signal
import threading


def heed_in_background() -> None:
    """Let SIGINT raise KeyboardInterrupt from now on where this process was started to ignore it.

    A shell starts the background jobs of a script so. A node takes the signal all the same, by
    rclpy's own handlers; what waits before it has a node, or without one, must ask for that.
    """
    ignored = signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    if ignored and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.default_int_handler)
