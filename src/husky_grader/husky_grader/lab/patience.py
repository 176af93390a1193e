# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How long a program is waited for: longer on a busy machine, where it has less of a processor."""

import os
from pathlib import Path
import time

MOST_TIMES = 10.0
"""So many times longer at most: a program may keep the machine busy itself."""

_LOAD = Path('/proc/loadavg')


class Patience:
    """A limit of time that passes slower while more want to run than there are processors."""

    def __init__(self, within_sec: float) -> None:
        self._left_sec, self._at_sec = within_sec, time.monotonic()

    def is_over(self) -> bool:
        """Return whether the time has passed; to be asked again and again meanwhile."""
        now_sec = time.monotonic()
        self._left_sec -= (now_sec - self._at_sec) / crowding()
        self._at_sec = now_sec
        return self._left_sec < 0.0


def crowding() -> float:
    """
    Return how many threads want to run for each processor now, 1 to MOST_TIMES.

    Both of the whole computer, in a container, too: proc_loadavg(5). 1 where nothing tells it.
    """
    try:
        running = int(_LOAD.read_text(encoding='ascii').split()[3].partition('/')[0])
    except (OSError, ValueError, IndexError):
        return 1.0
    return min(max(1.0, running / (os.cpu_count() or 1)), MOST_TIMES)
