# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read something repeatedly while a page is open."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
import sys
import threading
from typing import Generic, TypeVar

PERIOD_SEC = 1.0

Value = TypeVar('Value')


class Feed(Generic[Value]):
    """The newest value; read in a thread of its own while there is a watcher.

    :param read: returns the value; None: there is none now, and the one before still counts, as
        where it raises, which is said.
    """

    def __init__(self, read: Callable[[], Value | None], period_sec: float = PERIOD_SEC) -> None:
        self._read = read
        self._period_sec = period_sec
        self._changed = threading.Condition()
        self._value: Value | None = None
        self._version = 0
        self._watchers = 0
        threading.Thread(target=self._read_repeatedly, daemon=True, name='feed').start()

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Keep the value fresh inside the block."""
        with self._changed:
            self._watchers += 1
            self._changed.notify_all()
        try:
            yield
        finally:
            with self._changed:
                self._watchers -= 1

    def wait(self, seen: int, timeout_sec: float) -> tuple[int, Value | None]:
        """Return the value and its version, as soon as it is newer than the one seen."""
        with self._changed:
            self._changed.wait_for(lambda: self._version > seen, timeout_sec)
            return self._version, self._value

    def _read_repeatedly(self) -> None:
        trouble = ''
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._watchers > 0)
            value, before, trouble = None, trouble, ''
            try:
                value = self._read()
            except Exception as error:  # the next time it may be over, as too many open files
                trouble = f'{type(error).__name__}: {error}'
                if trouble != before:
                    print(f'nothing newer is shown: {trouble}', file=sys.stderr)
            with self._changed:
                if value is not None and value != self._value:
                    self._value = value
                    self._version += 1
                    self._changed.notify_all()
                self._changed.wait_for(lambda: self._watchers == 0, self._period_sec)
