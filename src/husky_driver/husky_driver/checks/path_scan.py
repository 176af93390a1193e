# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Look for obstacles on the path ahead in a scan of the laser."""

from collections.abc import Sequence
import math
from typing import NamedTuple

from husky_course.frames import Array, Pose
from husky_course.route import Curve, LIMITS
import numpy as np

LASER_X_M = 0.337  # front_laser in base_link
FRONT_M = 0.494  # from base_link to the bumper
HALF_WIDTH_M = 0.343 + 0.06  # of the robot, and what it may be off the path
DELAY_SEC = 0.15  # from what the laser sees to wheels that brake
MARGIN_M = 0.20  # between a corner of the robot and what it stops for
STEP_M = 0.05
AHEAD = 0.5  # cosine of the angle to which a beam looks ahead
EDGE_M = 0.2  # two neighbours in a scan that are further apart belong to two obstacles


class Scan(NamedTuple):
    """
    One scan; ranges that are not finite count as free, but for -inf.

    That is an obstacle too near to be measured (REP-117). One of NaN alone tells nothing and is
    not to be searched.
    """

    time_sec: float
    ranges: Sequence[float]
    first_angle_rad: float
    step_rad: float


class Sighting(NamedTuple):
    """An obstacle on the path: its distance from the bumper, its place and its width."""

    ahead_m: float
    x_m: float
    y_m: float
    width_m: float

    def __str__(self) -> str:
        """Return the words for the log."""
        return (
            f'something {self.width_m:.1f} m wide stands on the path, {self.ahead_m:.2f} m ahead '
            f'near ({self.x_m:.2f}, {self.y_m:.2f})'
        )


def look_along(
    scan: Scan,
    pose: Pose,
    curve: Curve,
    s: float,
    speed_m_s: float,
    *,
    braking_m_s2: float = LIMITS.stopping_m_s2,
    laser_x_m: float = LASER_X_M,
) -> Sighting | None:
    """
    Return what stands on the path; None when the way is free.

    Looks no further than a robot needs to stop.

    :param pose: of base_link in the frame of the curve.
    :param s: where on the curve the robot is.
    :param laser_x_m: how far ahead of base_link the laser stands.
    """
    stop_m = MARGIN_M + speed_m_s**2 / (2 * braking_m_s2) + DELAY_SEC * speed_m_s
    places = np.arange(s + FRONT_M, min(s + stop_m, curve.length_m) + FRONT_M, STEP_M)
    points = _points(scan, pose, laser_x_m, FRONT_M + stop_m)
    if len(places) == 0 or len(points) == 0:
        return None
    path = np.array([_beyond(curve, float(place)) for place in places])
    away = np.hypot(points[:, None, 0] - path[None, :, 0], points[:, None, 1] - path[None, :, 1])
    hit = np.nonzero(away.min(axis=0) < HALF_WIDTH_M)[0]
    if len(hit) == 0:
        return None
    nearest = int(away[:, hit[0]].argmin())
    x, y = points[nearest].tolist()
    ahead = max(math.hypot(x - pose[0], y - pose[1]) - FRONT_M, 0.0)
    return Sighting(ahead, x, y, _width_m(points, nearest))


def _points(scan: Scan, pose: Pose, laser_x_m: float, look_m: float) -> Array:
    ranges = np.asarray(scan.ranges)
    near = np.isfinite(ranges) & (ranges > 0.0) & (ranges < look_m + HALF_WIDTH_M)
    angles = scan.first_angle_rad + scan.step_rad * np.arange(len(ranges))
    # As if at the scanner itself; what is beside or behind it is not on the path.
    too_near = np.isneginf(ranges) & (np.cos(angles) > AHEAD)
    ranges, near = np.where(too_near, 0.0, ranges), near | too_near
    angles = angles[near] + pose[2]
    x = pose[0] + laser_x_m * math.cos(pose[2]) + ranges[near] * np.cos(angles)
    y = pose[1] + laser_x_m * math.sin(pose[2]) + ranges[near] * np.sin(angles)
    return np.stack([x, y], axis=1)


def _width_m(points: Array, one: int) -> float:
    """Return how far apart the ends of the obstacle are that a point belongs to."""
    gaps = np.hypot(*np.diff(points, axis=0).T)
    begins = np.nonzero(gaps > EDGE_M)[0] + 1
    obstacle = np.split(points, begins)[int(np.searchsorted(begins, one, side='right'))]
    return float(np.hypot(*(obstacle[-1] - obstacle[0])))


def _beyond(curve: Curve, s: float) -> tuple[float, float]:
    """Return a place on the curve, or straight on after its end, where the bumper gets to."""
    over = s - curve.length_m
    if over <= 0.0:
        return curve.point_at(s)
    x, y, heading = curve.x[-1], curve.y[-1], curve.heading[-1]
    return x + over * math.cos(heading), y + over * math.sin(heading)
