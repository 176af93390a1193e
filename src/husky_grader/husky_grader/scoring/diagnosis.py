# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Guess what a wrong run meant: typical mistakes leave typical traces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
import math

from husky_course.record import RunRecord
from husky_course.route import Curve
from husky_course.waypoints import Course
import numpy as np
import numpy.typing as npt

from husky_grader.scoring.alignment import align
from husky_grader.scoring.visits import waypoints_in_order

FAR_M = 0.5  # off the path by so much, it is worth guessing
NEAR_M = 0.3
DRIVEN_M = 2.0
DEGREES_RAD_S = 6.3  # nobody means a whole turn a second
ROUNDS = 2.0
ORDER_SHARE = 0.8  # of the waypoints but the first, where every run begins

Array = npt.NDArray[np.float64]
Turn = Callable[[Array, Array], tuple[Array, Array]]

MISTAKES: tuple[tuple[str, Turn], ...] = (
    ('mirrored: y is to the left of the Husky, not to its right', lambda x, y: (x, -y)),
    ('with x and y swapped: x is forward, y is to the left', lambda x, y: (y, x)),
    ('turned by 180 degrees: x is forward, not backward', lambda x, y: (-x, -y)),
    ('turned by 90 degrees to the left: x is forward, y is to the left', lambda x, y: (y, -x)),
    ('turned by 90 degrees to the right: x is forward, y is to the left', lambda x, y: (-y, x)),
)


def guesses(
    run: RunRecord, course: Course, curve: Curve, *, rms_m: float, driven_m: float
) -> list[str]:
    """Return what the mistake may be; nothing when the run leaves no such trace."""
    lines = [*_units(run), *_rounds(run, curve), *_order(run, course)]
    return lines or _frame(run, curve, rms_m, driven_m)


def _order(run: RunRecord, course: Course) -> list[str]:
    back = replace(course, waypoints=course.waypoints[::-1])
    reached, in_order = (waypoints_in_order(c, run.x, run.y) for c in (back, course))
    if sum(reached) <= max(sum(in_order), ORDER_SHARE * (len(reached) - 1)):
        return []
    return ['it drove the course from its end to its beginning: keep the order of the file']


def _units(run: RunRecord) -> list[str]:
    fastest = _greatest(run.command_yaw_rate_rad_s)
    if abs(fastest) > DEGREES_RAD_S:
        return [
            f'it commanded angular.z = {fastest:g}: that is rad/s, not degrees; '
            'the Husky turns 2 rad/s at most'
        ]
    speed = _greatest(run.command_speed_m_s)
    if abs(speed) > 3.0:
        return [f'it commanded linear.x = {speed:g}: that is m/s; the Husky drives 1 m/s at most']
    return []


def _greatest(values: Array) -> float:
    return float(values[np.abs(values).argmax()])


def _rounds(run: RunRecord, curve: Curve) -> list[str]:
    """Tell of a robot that turned round and round, as one does that takes degrees for radians."""
    turns = np.diff(run.yaw)
    turned = float(np.abs(turns - 2 * math.pi * np.rint(turns / (2 * math.pi))).sum())
    needed = sum(
        abs(after - before)
        for before, after in zip(curve.heading, curve.heading[1:], strict=False)
    )
    extra = (turned - needed) / (2 * math.pi)
    if extra < ROUNDS:
        return []
    return [
        f'it turned {extra:.1f} rounds more than the path does: angles are in radians, and an '
        'angle between two headings must be brought back to -pi..pi'
    ]


def _frame(run: RunRecord, curve: Curve, rms_m: float, driven_m: float) -> list[str]:
    if rms_m < FAR_M or driven_m < DRIVEN_M:
        return []
    best, what = rms_m / 2, ''
    for name, turn in MISTAKES:
        _, offsets = align(curve, *turn(run.x, run.y))
        rms = math.sqrt(float(np.mean(offsets**2)))
        if rms < min(best, NEAR_M):
            best, what = rms, name
    return [f'it drove the course {what}'] if what else []
