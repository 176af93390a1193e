# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What obstacles look like from above, and how near a robot comes to them.

An outline is a circle or a rectangle: enough for every obstacle of the playpen, and for any other
the smallest rectangle around it, in the direction the body faces. An obstacle that is mostly
empty, as the walls of a room, has several of its name, one around each part.
"""

from collections.abc import Sequence
from dataclasses import dataclass
import math

import numpy as np

from husky_course.frames import Array
from husky_course.robot import ROBOT_LENGTH_M, ROBOT_WIDTH_M

_CHUNK = 20_000  # poses at a time: a day of them would take gigabytes


@dataclass(frozen=True, kw_only=True)
class Outline:
    """An obstacle, or a part of one, seen from above, in the frame `world`: metres and radians."""

    name: str
    x: float
    y: float
    yaw: float
    size: tuple[float, ...]  # (radius,) of a circle, or the lengths along x and y of a rectangle

    @property
    def type(self) -> str:
        """Tell `circle` from `rect`."""
        return 'circle' if len(self.size) == 1 else 'rect'


def least_clearance(poses: Array, outlines: Sequence[Outline]) -> float:
    """
    Return the least of the clearances of all poses, without measuring those that are far away.

    :param poses: one row for every pose: x, y, yaw.
    """
    least = math.inf
    robot_m = math.hypot(ROBOT_LENGTH_M, ROBOT_WIDTH_M) / 2.0
    for outline in outlines:
        reach_m = robot_m + math.hypot(*outline.size) / (1.0 if outline.type == 'circle' else 2.0)
        at_least = np.hypot(poses[:, 0] - outline.x, poses[:, 1] - outline.y) - reach_m
        likely = int(at_least.argmin())
        least = min(least, float(_clearance(poses[likely : likely + 1], outline)[0]))
        near = np.flatnonzero(at_least < least + 1e-9)
        for first in range(0, len(near), _CHUNK):
            chunk = poses[near[first : first + _CHUNK]]
            least = min(least, float(_clearance(chunk, outline).min()))
    return least


def clearances(poses: Array, outlines: Sequence[Outline]) -> Array:
    """
    Return the plan distance of the robot's rectangle to the nearest outline, for every pose.

    :param poses: one row for every pose: x, y, yaw.
    """
    nearest = np.full(len(poses), math.inf)
    for outline in outlines:
        nearest = np.minimum(nearest, _clearance(poses, outline))
    return nearest


def _clearance(poses: Array, outline: Outline) -> Array:
    robot = np.array([ROBOT_LENGTH_M / 2.0, ROBOT_WIDTH_M / 2.0])
    middle = np.array([[outline.x, outline.y]])
    if outline.type == 'circle':
        away = _to_rectangle(_into(poses, middle), robot)[:, 0] - outline.size[0]
        return np.maximum(away, 0.0)
    half = np.array(outline.size) / 2.0
    pose = np.array([[outline.x, outline.y, outline.yaw]])
    corners = _out_of(pose, _corners(half))[0]
    robot_corners = _out_of(poses, _corners(robot))
    theirs = _into(poses, corners)
    ours = _into(pose, robot_corners.reshape(-1, 2)).reshape(len(poses), 4, 2)
    away = np.minimum(
        _to_rectangle(theirs, robot).min(axis=1), _to_rectangle(ours, half).min(axis=1)
    )
    apart = np.logical_or(_beside(theirs, robot), _beside(ours, half))
    return np.where(apart, away, 0.0)


def _corners(half: Array) -> Array:
    return half * np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]])


def _out_of(poses: Array, points: Array) -> Array:
    """Bring points from the frame of every pose into the world: shape (poses, points, 2)."""
    cos, sin = np.cos(poses[:, 2, None]), np.sin(poses[:, 2, None])
    x = poses[:, 0, None] + cos * points[:, 0] - sin * points[:, 1]
    y = poses[:, 1, None] + sin * points[:, 0] + cos * points[:, 1]
    return np.stack([x, y], axis=2)


def _into(poses: Array, points: Array) -> Array:
    """Bring points from the world into the frame of every pose: shape (poses, points, 2)."""
    cos, sin = np.cos(poses[:, 2, None]), np.sin(poses[:, 2, None])
    x = points[:, 0] - poses[:, 0, None]
    y = points[:, 1] - poses[:, 1, None]
    return np.stack([cos * x + sin * y, cos * y - sin * x], axis=2)


def _to_rectangle(points: Array, half: Array) -> Array:
    """Return the distance of points to a rectangle around the origin."""
    outside = np.maximum(np.abs(points) - half, 0.0)
    return np.hypot(outside[..., 0], outside[..., 1])


def _beside(corners: Array, half: Array) -> Array:
    """Tell whether all four corners lie on one side of a rectangle: a separating axis."""
    beyond = (corners.min(axis=1) > half) | (corners.max(axis=1) < -half)
    return beyond.any(axis=1)
