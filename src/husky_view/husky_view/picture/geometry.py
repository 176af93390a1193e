# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Geometry of the plane: the frames odom and world, the ground, and distances."""

from collections.abc import Sequence
import math

from husky_course.frames import Array
from husky_course.outline import Outline
from husky_course.robot import RobotStart
import numpy as np

from husky_course import frames

Bounds = tuple[float, float, float, float]
"""Least and greatest x and y, in metres."""


def to_world(start: RobotStart, points: Array) -> Array:
    """Transform points (n, 2) from the frame odom of a robot with this start into the world."""
    return np.stack(frames.to_world(start.pose, *points.T), axis=1)


def to_odom(start: RobotStart, points: Array) -> Array:
    """Transform points (n, 2) of the world into the frame odom of a robot with this start."""
    return np.stack(frames.to_odom(start.pose, *points.T), axis=1)


def bounds(outlines: Sequence[Outline], *, at_least_m: float) -> Bounds:
    """
    Return the least and greatest x and y of obstacles.

    :param at_least_m: what they contain in any case, in each direction from the middle.
    """
    middles = np.array([(each.x, each.y) for each in outlines]).reshape(-1, 2)
    reaches = np.array([_reach(each) for each in outlines]).reshape(-1, 2)
    some = np.full((1, 2), at_least_m)
    low = np.concatenate([middles - reaches, -some]).min(axis=0)
    high = np.concatenate([middles + reaches, some]).max(axis=0)
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def _reach(outline: Outline) -> tuple[float, float]:
    """Return how far an obstacle reaches from its middle along x and y."""
    if outline.type == 'circle':
        return outline.size[0], outline.size[0]
    half_x, half_y = outline.size[0] / 2.0, outline.size[1] / 2.0
    across, along = abs(math.sin(outline.yaw)), abs(math.cos(outline.yaw))
    return along * half_x + across * half_y, across * half_x + along * half_y


def on_ground(
    origin: Sequence[float] | Array, direction: Sequence[float] | Array, height_m: float
) -> Array | None:
    """Return the (x, y) where a ray meets level ground; None if it does not."""
    if direction[2] >= -1e-6 or origin[2] <= height_m:
        return None
    along = (height_m - origin[2]) / direction[2]
    return np.array([origin[0] + along * direction[0], origin[1] + along * direction[1]])


def distance_to_line(point: Array, line: Array) -> float:
    """
    Return the distance of a point to a polyline (n, 2), positive to the left of it.

    :raises ValueError: if the line has fewer than two points.
    """
    if len(line) < 2:
        raise ValueError(f'{len(line)} points: a line needs at least 2')
    begin, along = line[:-1], np.diff(line, axis=0)
    lengths = np.maximum((along**2).sum(axis=1), 1e-12)
    part = np.clip(((point - begin) * along).sum(axis=1) / lengths, 0.0, 1.0)
    away = point - (begin + part[:, None] * along)
    nearest = int(np.argmin((away**2).sum(axis=1)))
    side = along[nearest][0] * away[nearest][1] - along[nearest][1] * away[nearest][0]
    return math.copysign(math.hypot(*away[nearest]), side)
