# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Show how far a drive has come: one bar on a terminal, else a line every 10 %."""

from collections.abc import Callable
import math
import shutil
import sys
from typing import TextIO

BAR_WIDTH = 30


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
        if tenth > self._tenth or tenth < self._tenth - 1:  # or another drive has begun
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
