# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
When a drive has taken too long: a limit that follows from its course, and a rule of progress.

All times are simulated ones: a slow or busy computer is no reason to end a drive.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

from husky_course.route.route import Leg

from husky_driver.drive.tracker import DriveLimits, plan_speeds

STOP_ALLOWANCE_SEC = 1.0  # for each stop on the way, beside the turning
TURN_ALLOWANCE_RAD_S = 1.0
LIMIT_FACTOR, LIMIT_EXTRA_SEC = 3.0, 20.0  # of the time that the course takes
NO_NEARER_SEC = 30.0
NEARER_M = 0.01  # less than this is no progress


def par_time_sec(legs: Sequence[Leg]) -> float:
    """Return the time the course takes at the asked speed, with allowances for its stops."""
    seconds, heading = 0.0, 0.0
    for leg in legs:
        knots = leg.curve.knot_s
        seconds += sum((knots[i + 1] - knots[i]) / speed for i, speed in enumerate(leg.speeds_m_s))
        facing = leg.curve.heading[0] + (math.pi if leg.reverse else 0.0)
        seconds += abs(math.remainder(facing - heading, 2 * math.pi)) / TURN_ALLOWANCE_RAD_S
        seconds += STOP_ALLOWANCE_SEC + leg.dwell_sec
        heading = leg.curve.heading[-1] + (math.pi if leg.reverse else 0.0)
        if leg.end_yaw_rad is not None:
            turn = math.remainder(leg.end_yaw_rad - heading, 2 * math.pi)
            seconds += abs(turn) / TURN_ALLOWANCE_RAD_S
            heading = leg.end_yaw_rad
    return seconds


def limit_sec(legs: Sequence[Leg]) -> float:
    """Return how long a course may take: three times what it needs, bends included, and 20 s."""
    limits = DriveLimits()
    slowed = sum(_slowed_sec(leg, limits) for leg in legs)
    return LIMIT_FACTOR * (par_time_sec(legs) + slowed) + LIMIT_EXTRA_SEC


def _slowed_sec(leg: Leg, limits: DriveLimits) -> float:
    """Return how much longer a leg takes than at the asked speed, for its bends and its end."""
    s, knots = leg.curve.s, leg.curve.knot_s
    speeds = plan_speeds(leg.curve, leg.speeds_m_s, limits)
    planned = sum(2.0 * (s[i + 1] - s[i]) / (speeds[i] + speeds[i + 1]) for i in range(len(s) - 1))
    asked = sum((knots[i + 1] - knots[i]) / speed for i, speed in enumerate(leg.speeds_m_s))
    return max(planned - asked, 0.0)


class TimeLimit:
    """Counts the time of one drive; ask it at every odometry, in order."""

    def __init__(self, legs: Sequence[Leg], begun_sec: float) -> None:
        self.limit_sec = limit_sec(legs)
        self._last_sec = begun_sec
        self._driven_sec = 0.0
        self._no_nearer_sec = 0.0

    def complaint(
        self, time_sec: float, *, nearer: bool, held: bool = False, dwelling: bool = False
    ) -> str:
        """
        Return why the drive must end, or nothing.

        :param nearer: it has come nearer to its goal than ever before.
        :param held: somebody lets it wait: this time does not count.
        :param dwelling: it stands where and as long as the course says: no progress is needed.
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
