# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
When a drive has taken too long: a limit that follows from its course, and a rule of progress.

All times are simulated ones: a slow or busy computer is no reason to end a drive.
"""

from husky_course.route import LIMIT_EXTRA_SEC, LIMIT_FACTOR, Route

NO_NEARER_SEC = 30.0
NEARER_M = 0.01  # less than this is no progress


class TimeLimit:
    """Counts the time of one drive; call it with every odometry, in order."""

    def __init__(self, route: Route, begun_sec: float) -> None:
        self.limit_sec = route.limit_sec
        self._last_sec = begun_sec
        self._driven_sec = 0.0
        self._no_nearer_sec = 0.0

    def complaint(
        self, time_sec: float, *, nearer: bool, held: bool = False, dwelling: bool = False
    ) -> str:
        """
        Return why the drive must end, or nothing.

        :param nearer: it has come nearer to its goal than ever before.
        :param held: the drive is paused: this time does not count.
        :param dwelling: it stands at a waypoint as the course asks: no progress is needed.
        """
        period_sec = max(time_sec - self._last_sec, 0.0)  # a reset takes nothing back
        self._last_sec = time_sec
        if held:
            return ''
        self._driven_sec += period_sec
        self._no_nearer_sec = 0.0 if nearer else self._no_nearer_sec + period_sec * (not dwelling)
        if self._no_nearer_sec > NO_NEARER_SEC:
            return f'it came no nearer to its goal for {NO_NEARER_SEC:g} s'
        if self._driven_sec > self.limit_sec:
            needed_sec = (self.limit_sec - LIMIT_EXTRA_SEC) / LIMIT_FACTOR
            return f'time is up after {self.limit_sec:.0f} s, the course needs {needed_sec:.0f} s'
        return ''
