# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Lay what was driven along the path it should have been, once and for the whole run.

The nearest point alone would jump where a course crosses or comes back to itself. Here the
places on the path may only go forward in time, and among all such ways the one with the least
squared distance is taken (dynamic time warping with free steps along the path, by dynamic
programming).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from husky_driver.path import Curve

MAX_POSES = 2500
PATH_STEP_M = 0.05
MAX_PLACES = 2500


def align(curve: Curve, x: Sequence[float], y: Sequence[float]) -> tuple[list[float], list[float]]:
    """Return for every pose its place along the curve and its offset to the left of it."""
    every = max(1, -(-len(x) // MAX_POSES))
    poses = range(0, len(x), every)
    places = _places(curve)
    path = np.array([curve.point_at(s) for s in places])
    steps = _best_steps(path, np.array([[x[i], y[i]] for i in poses]))
    s_along: list[float] = []
    offsets: list[float] = []
    for i in range(len(x)):
        near = curve.index_at(places[steps[i // every]])
        _, s, offset = curve.project(near, x[i], y[i])
        s_along.append(s)
        offsets.append(offset)
    return s_along, offsets


def _places(curve: Curve) -> list[float]:
    count = min(max(2, round(curve.length_m / PATH_STEP_M) + 1), MAX_PLACES)
    return [curve.length_m * k / (count - 1) for k in range(count)]


def _best_steps(path: np.ndarray, poses: np.ndarray) -> list[int]:
    """Return the index into the path for each pose: never decreasing, least squares."""
    count = len(path)
    came_from = np.empty((len(poses), count), dtype=np.int16)
    cost = np.zeros(count)
    indices = np.arange(count)
    for k, pose in enumerate(poses):
        lowest = np.minimum.accumulate(cost)
        fresh = np.empty(count, dtype=bool)
        fresh[0], fresh[1:] = True, cost[1:] < lowest[:-1]
        came_from[k] = np.maximum.accumulate(np.where(fresh, indices, 0))
        away = path - pose
        cost = lowest + np.einsum('ij,ij->i', away, away)
    place = int(np.argmin(cost))
    steps = [0] * len(poses)
    for k in range(len(poses) - 1, -1, -1):
        steps[k] = place
        place = int(came_from[k][place])
    return steps
