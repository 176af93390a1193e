# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The wall clock against simulated time.

A simulation that fell behind catches up, but only by CATCH_UP_SEC of wall time: after a longer
delay it continues from where it is. The physics never takes a longer step.
"""

import math

CATCH_UP_SEC = 0.1

EARLY = 0.25
"""How much too early a timer may be, as a part of a period, and still count as on time."""


class Pacer:
    """Computes how many control periods are due. Times are of a steady wall clock, in seconds."""

    def __init__(self, *, period_sec: float, real_time_factor: float) -> None:
        self._period_sec = period_sec
        self.overruns = 0
        self.lost_sec = 0.0
        self.change(real_time_factor)

    def change(self, real_time_factor: float, *, begin_sec: float | None = None) -> None:
        """
        Continue at another pace; the counts of lost time stay.

        :param begin_sec: when the timer that calls `due` was made. Periods fall due at its ticks:
            due times between two ticks would be rounded now to the one, now to the other.
        """
        self._begin_sec = begin_sec
        self._wall_period_sec = self._period_sec / real_time_factor
        self._next_sec: float | None = None

    def restart(self) -> None:
        """Begin again at the next call of `due`, after a pause."""
        self._next_sec = None

    def due(self, now_sec: float, *, most: int = 1000) -> int:
        """Return how many periods to advance now; they count as done."""
        if self._next_sec is None:
            self._next_sec = self._tick_near(now_sec)
        late_sec = now_sec - self._next_sec
        if late_sec < -EARLY * self._wall_period_sec:
            return 0
        if late_sec > CATCH_UP_SEC + self._wall_period_sec:
            self.overruns += 1
            self.lost_sec += late_sec
            self._next_sec = self._tick_near(now_sec)
            late_sec = now_sec - self._next_sec
        periods = min(most, 1 + math.floor(max(late_sec, 0.0) / self._wall_period_sec))
        self._next_sec += periods * self._wall_period_sec
        return periods

    def _tick_near(self, now_sec: float) -> float:
        if self._begin_sec is None:
            return now_sec
        ticks = round((now_sec - self._begin_sec) / self._wall_period_sec)
        return self._begin_sec + ticks * self._wall_period_sec
