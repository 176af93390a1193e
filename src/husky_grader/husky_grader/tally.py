# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Count what is done: one bar on a terminal, else a line every 10 %."""

import shutil
import time
from typing import TextIO

from husky_runtime.command_line import discard

BAR_WIDTH = 30
ENOUGH_TO_TELL = 2  # files, from which the time for the rest is told
SHORT_SEC = 5.0  # less is not worth telling


class Tally:
    """Counts files, submissions or waypoints, and shows how many there are."""

    def __init__(self, total: int, stream: TextIO, begun: str, *, bar: bool) -> None:
        self._total = total
        self._stream = stream
        self._bar = bar
        self._count = 0
        self._new = 0
        self._began_sec = time.monotonic()
        if bar:
            self._show(begun)

    def add(self, note: str, *, is_new: bool = True) -> None:
        """
        Count one more, and show the note about it.

        :param is_new: whether it has taken its time now, and tells how long the rest will take.
        """
        self._count += 1
        self._new += is_new
        self._show(f'{self._left()}{note}')

    def _left(self) -> str:
        """Return in words how long the rest will take, if that can be told."""
        left = self._total - self._count
        if not left or self._new < ENOUGH_TO_TELL:
            return ''
        left_sec = (time.monotonic() - self._began_sec) / self._new * left
        if left_sec < SHORT_SEC:
            return ''
        return (
            f'about {left_sec:.0f} s left  '
            if left_sec < 90.0
            else (f'about {left_sec / 60.0:.0f} min left  ')
        )

    def _show(self, note: str) -> None:
        done = BAR_WIDTH * self._count // max(self._total, 1)
        text = f'{self._count} of {self._total}  {note}'
        if self._bar:
            width = max(shutil.get_terminal_size().columns - 1, 10)
            bar = f'[{"#" * done}{"." * (BAR_WIDTH - done)}] {text}'
            self._write('\r' + bar[:width].ljust(width))
        elif self._count * 10 // self._total > (self._count - 1) * 10 // self._total:
            self._write(text + '\n')

    def close(self) -> None:
        if self._bar:
            self._write('\n')

    def _write(self, text: str) -> None:
        try:
            self._stream.write(text)
            self._stream.flush()
        except BrokenPipeError:  # who has read it has ended
            raise
        except OSError:  # the disk is full; the work goes on
            discard(self._stream)
