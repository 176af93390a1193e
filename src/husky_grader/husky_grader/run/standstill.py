# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What is tried while the computer stands still is tried again: what came of it says nothing.

A frozen container, a suspended job of a cluster, a paused virtual machine, a laptop put to sleep:
the clock goes on. Afterwards nodes have held each other for dead (DDS does so after 20 s), rates
are wrong, and what was waited for seems never to have come.
"""

from collections.abc import Callable
from threading import Event, Thread
import time
from typing import TypeVar

STILL_SEC = 2.0
"""A shorter pause disturbs nothing; on a busy machine a thread waits less for its turn."""

MOST_TIMES = 3
"""Where a computer stands still again and again, the last try counts."""

_LOOK_SEC = 0.1

T = TypeVar('T')


def undisturbed(attempt: Callable[[], T]) -> T:
    """Return what comes of an attempt, or of another when the computer stood still meanwhile."""
    for _ in range(MOST_TIMES - 1):
        watch = Watch()
        try:
            result = attempt()
        except Exception:
            if not watch.end():
                raise
        else:
            if not watch.end():
                return result
    return attempt()


class Watch:
    """A thread that is never later than a moment, unless nothing runs; it begins at once."""

    def __init__(self) -> None:
        self._over = Event()
        self._stood_still = False
        self._thread = Thread(target=self._look, daemon=True)
        self._thread.start()

    def end(self) -> bool:
        """Return whether the computer has stood still since the beginning."""
        self._over.set()
        self._thread.join()
        return self._stood_still

    def _look(self) -> None:
        # By the clock that messages are stamped with: it counts sleep, and may be set.
        before_sec, is_over = time.time(), False
        while not is_over:
            is_over = self._over.wait(_LOOK_SEC)
            now_sec = time.time()
            self._stood_still |= abs(now_sec - before_sec) > STILL_SEC
            before_sec = now_sec
