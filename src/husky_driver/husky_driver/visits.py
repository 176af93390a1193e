# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which waypoints a run reached, in the order of the course."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence

import numpy as np

from husky_driver.waypoints import Course


def waypoints_in_order(course: Course, x: Sequence[float], y: Sequence[float]) -> list[bool]:
    """
    Tell for each of `course.stops` whether the run reached it.

    Of all ways to count waypoints in the order of the course, the one that counts most is taken
    (longest increasing subsequence): one that was left out costs itself, not all that follow.
    The last stop of a loop counts when the run ends there and reached half of the others.
    """
    px, py = np.asarray(x), np.asarray(y)
    away = [np.hypot(px - point.x_m, py - point.y_m) for point in course.waypoints]
    within = [np.nonzero(distance <= course.tolerance_m)[0] for distance in away]
    visits = sorted((int(i), number) for number, at in enumerate(within) for i in at)
    counted = _longest_increasing([number for _, number in visits])
    reached = [number in counted for number in range(len(course.waypoints))]
    if course.loop:
        back = len(px) > 0 and bool(away[0][-1] <= course.tolerance_m)
        reached.append(back and 2 * sum(reached) >= len(reached))
    return reached


def _longest_increasing(numbers: Sequence[int]) -> set[int]:
    tails: list[int] = []  # the smallest last number of a chain of each length
    tail_at: list[int] = []
    before: list[int] = []
    for at, number in enumerate(numbers):
        length = bisect_left(tails, number)
        before.append(tail_at[length - 1] if length else -1)
        if length == len(tails):
            tails.append(number)
            tail_at.append(at)
        else:
            tails[length], tail_at[length] = number, at
    chain = set()
    at = tail_at[-1] if tail_at else -1
    while at >= 0:
        chain.add(numbers[at])
        at = before[at]
    return chain
