# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Show how far a drive has come: one bar on a terminal, else a line every 10 %."""

from collections.abc import Callable
import math
import shutil
import sys
import time
from typing import TextIO

BAR_WIDTH = 30
ENOUGH_TO_TELL = 2  # files, from which the time for the rest is told
SHORT_SEC = 5.0  # less is not worth telling


class Progress:
    """Shows the distance left and the time; `line` receives what is not a bar."""

    def __init__(self, stream: TextIO, line: Callable[[str], None], *, bar: bool) -> None:
        self._stream = stream
        self._line = line
        self._bar = bar
        self._tenth = 0
        self._shown = False

    def update(self, length_m: float, remaining_m: float, elapsed_sec: float, note: str) -> None:
        if not math.isfinite(remaining_m) or not math.isfinite(length_m):
            return
        part = min(max(1.0 - remaining_m / max(length_m, 1e-9), 0.0), 1.0)
        if self._bar:
            self._draw(part, f'{remaining_m:6.2f} m left  {elapsed_sec:6.1f} s  {note}')
            return
        tenth = int(part * 10 + 1e-9)
        if tenth > self._tenth:
            self._tenth = tenth
            self._line(f'{tenth * 10} %: {remaining_m:.2f} m left, {elapsed_sec:.1f} s, {note}')

    def _draw(self, part: float, text: str) -> None:
        width = max(shutil.get_terminal_size().columns - 1, 10)
        done = round(part * BAR_WIDTH)
        bar = f'[{"#" * done}{"." * (BAR_WIDTH - done)}] {part:4.0%}  {text}'
        if len(bar) > width:
            bar = f'{part:4.0%}  {text}'
        self._stream.write('\r' + bar[:width].ljust(width))
        self._stream.flush()
        self._shown = True

    def close(self) -> None:
        """Leave the bar's line, so that what is printed next begins at its start."""
        if self._shown:
            self._stream.write('\n')
            self._stream.flush()
            self._shown = False


def make_progress(mode: str, line: Callable[[str], None]) -> Progress:
    """Return what shows progress in one of the modes auto, bar, lines and off."""
    bar = mode == 'bar' or (mode == 'auto' and sys.stdout.isatty())
    return Progress(sys.stdout, (lambda _: None) if mode == 'off' else line, bar=bar)


class Tally:
    """Counts files: one bar on a terminal, else a line every 10 %."""

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
            self._stream.write('\r' + bar[:width].ljust(width))
        elif self._count * 10 // self._total > (self._count - 1) * 10 // self._total:
            self._stream.write(text + '\n')
        self._stream.flush()

    def close(self) -> None:
        if self._bar:
            self._stream.write('\n')
            self._stream.flush()
