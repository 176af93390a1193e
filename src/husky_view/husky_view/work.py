# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What was clicked and is still to be done.

Clicks come in on threads of the server; everything else belongs to one other thread.
"""

from collections.abc import Callable
from queue import Empty, SimpleQueue


class Work:
    """A queue of actions."""

    def __init__(self) -> None:
        self._queue: SimpleQueue[Callable[[], object]] = SimpleQueue()

    def put(self, action: Callable[[], object]) -> None:
        """Leave an action to be done; from any thread."""
        self._queue.put(action)

    def do(self) -> None:
        """Do what was left since the last call."""
        while True:
            try:
                action = self._queue.get_nowait()
            except Empty:
                return
            action()
