# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which waypoints a run reached, in the order of the course."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence

from husky_course.waypoints import Course, Waypoint
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

CHUNK = 500  # entries, ten seconds: how far the run was from a waypoint is asked of all at once


def waypoints_in_order(course: Course, x: Array, y: Array) -> list[bool]:
    """
    Tell for each of `course.stops` whether the run reached it.

    Of all ways to count waypoints in the order of the course, the one that counts most is taken
    (longest increasing subsequence): one that was left out costs itself, not all that follow.
    The last stop of a loop counts when the run ends there and reached half of the others.
    """
    boxes = _boxes(x, y)
    stays = [_stays(boxes, x, y, point, course.tolerance_m) for point in course.waypoints]
    # As long as the same waypoints are near, one entry tells as much as all of them.
    changes = np.unique(np.concatenate(stays))
    visits = sorted(
        (int(change), number)
        for number, ends in enumerate(stays)
        for begin, end in ends
        for change in changes[(changes >= begin) & (changes < end)]
    )
    counted = _longest_increasing([number for _, number in visits])
    reached = [number in counted for number in range(len(course.waypoints))]
    if course.loop:
        back = bool(stays[0].size) and bool(stays[0][-1, 1] == len(x))
        reached.append(back and 2 * sum(reached) >= len(reached))
    return reached


def _boxes(x: Array, y: Array) -> Array:
    """Return the least and greatest x and y of each CHUNK entries, one row each."""
    first = np.arange(0, len(x), CHUNK)
    least, greatest = np.minimum.reduceat, np.maximum.reduceat
    return np.stack([least(x, first), greatest(x, first), least(y, first), greatest(y, first)])


def _stays(boxes: Array, x: Array, y: Array, point: Waypoint, tolerance_m: float) -> Indices:
    """Return rows of the first entry of each stay near a waypoint, and of that after its last."""
    low_x, high_x, low_y, high_y = boxes
    close = (low_x <= point.x_m + tolerance_m) & (high_x >= point.x_m - tolerance_m)
    close &= (low_y <= point.y_m + tolerance_m) & (high_y >= point.y_m - tolerance_m)
    entries = (np.flatnonzero(close)[:, None] * CHUNK + np.arange(CHUNK)).ravel()
    entries = entries[entries < len(x)]
    away_m = np.hypot(x[entries] - point.x_m, y[entries] - point.y_m)
    near = entries[away_m <= tolerance_m]
    gaps = np.diff(near, prepend=-2, append=len(x) + 1) > 1
    return np.stack([near[gaps[:-1]], near[gaps[1:]] + 1], axis=1)


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
