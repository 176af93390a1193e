# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A log that is never larger than allowed: its begin, its end, and how much is left out."""

import contextlib
import os
from pathlib import Path
import time

_SHOWN_SEC = 0.1  # between two times of writing the end


class Log:
    """
    A file of what a program prints; a context manager that completes it.

    While the program runs, it holds the begin and what was printed last, with no word between.
    """

    def __init__(self, path: Path, most_bytes: int) -> None:
        """
        Begin the file anew.

        :raises OSError: if it cannot be written.
        """
        self._file = path.open('wb', buffering=0)
        self._head_left = self._most_head = most_bytes - most_bytes // 2
        self._tail, self._most_tail = bytearray(), most_bytes // 2
        self._left_out = 0
        self._shown_sec = 0.0
        self._is_shown = True

    def __enter__(self) -> 'Log':
        return self

    def __exit__(self, *_: object) -> None:
        if self._left_out:
            self._write(f'\n[{self._left_out} bytes of the log are left out here]\n'.encode())
        self._write(self._tail)
        with contextlib.suppress(OSError):
            self._file.close()

    def add(self, printed: bytes) -> None:
        """Add what was printed; see `show` for what may be the end."""
        head = printed[: self._head_left]
        self._write(head)
        self._head_left -= len(head)
        self._tail += printed[len(head) :]
        self._is_shown = not self._tail
        if (over := len(self._tail) - self._most_tail) > 0:
            self._left_out += over
            del self._tail[:over]

    def show(self) -> None:
        """Write what may be the end, if that is due; call it again and again."""
        now_sec = time.monotonic()
        if not self._is_shown and now_sec - self._shown_sec >= _SHOWN_SEC:
            self._is_shown, self._shown_sec = True, now_sec
            with contextlib.suppress(OSError):
                os.pwrite(self._file.fileno(), self._tail, self._most_head)

    def note(self, line: str) -> None:
        """Add a line of the grader's own."""
        self.add(f'\n[{line}]\n'.encode())

    def _write(self, text: bytes | bytearray) -> None:
        with contextlib.suppress(OSError):  # a full disk costs lines of the log, not the run
            self._file.write(text)
