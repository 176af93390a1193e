# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How fast simulated time passes, measured."""

from collections import deque

WINDOW_SEC = 1.0


class Pace:
    """The achieved real-time factor over the last second of wall time."""

    def __init__(self) -> None:
        self._samples: deque[tuple[float, float]] = deque()

    def add(self, *, wall_sec: float, time_sec: float) -> None:
        """Take a sample; simulated time that goes backwards begins anew."""
        if self._samples and time_sec < self._samples[-1][1]:
            self._samples.clear()
        self._samples.append((wall_sec, time_sec))
        while wall_sec - self._samples[0][0] > WINDOW_SEC:
            self._samples.popleft()

    @property
    def factor(self) -> float | None:
        """Return simulated over wall time, once there is something to measure."""
        if len(self._samples) < 2:
            return None
        (wall_0, time_0), (wall_1, time_1) = self._samples[0], self._samples[-1]
        return (time_1 - time_0) / (wall_1 - wall_0) if wall_1 > wall_0 else None
