# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Look along the path with the laser for something that should not stand there."""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np

from husky_driver.path import Curve

LASER_X_M = 0.337  # front_laser in base_link
FRONT_M = 0.494  # from base_link to the bumper
HALF_WIDTH_M = 0.343 + 0.06  # of the robot, and what it may be off the path
BRAKING_M_S2 = 1.0
MARGIN_M = 0.30  # between the bumper and what it stops for
STEP_M = 0.05

Pose = tuple[float, float, float]


def blocked_at_m(
    ranges: Sequence[float],
    first_angle_rad: float,
    step_rad: float,
    *,
    pose: Pose,
    curve: Curve,
    s: float,
    speed_m_s: float,
) -> float | None:
    """
    Return how far before the bumper something stands on the path; None when the way is free.

    Looks no further than the robot needs to stop. Ranges that are no number count as free.

    :param pose: of base_link in the frame of the curve.
    :param s: where on the curve the robot is.
    """
    stop_m = MARGIN_M + speed_m_s**2 / (2 * BRAKING_M_S2) + 0.1 * speed_m_s
    places = np.arange(s + FRONT_M, min(s + stop_m, curve.length_m) + FRONT_M, STEP_M)
    points = _points(np.asarray(ranges), first_angle_rad, step_rad, pose, FRONT_M + stop_m)
    if len(places) == 0 or len(points) == 0:
        return None
    path = np.array([_beyond(curve, float(place)) for place in places])
    away = np.hypot(
        points[:, None, 0] - path[None, :, 0], points[:, None, 1] - path[None, :, 1]
    ).min(axis=0)
    hit = np.nonzero(away < HALF_WIDTH_M)[0]
    return float(places[hit[0]] - s - FRONT_M) if len(hit) else None


def _points(
    ranges: np.ndarray, first_angle_rad: float, step_rad: float, pose: Pose, look_m: float
) -> np.ndarray:
    near = np.isfinite(ranges) & (ranges > 0.0) & (ranges < look_m + HALF_WIDTH_M)
    angles = first_angle_rad + step_rad * np.nonzero(near)[0] + pose[2]
    x = pose[0] + LASER_X_M * math.cos(pose[2]) + ranges[near] * np.cos(angles)
    y = pose[1] + LASER_X_M * math.sin(pose[2]) + ranges[near] * np.sin(angles)
    return np.stack([x, y], axis=1)


def _beyond(curve: Curve, s: float) -> tuple[float, float]:
    """Return a place on the curve, or straight on after its end, where the bumper comes to be."""
    over = s - curve.length_m
    if over <= 0.0:
        return curve.point_at(s)
    x, y, heading = curve.x[-1], curve.y[-1], curve.heading[-1]
    return x + over * math.cos(heading), y + over * math.sin(heading)
