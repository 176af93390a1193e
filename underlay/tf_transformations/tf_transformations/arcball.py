# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A ball that a mouse turns (Shoemake, Graphics Gems IV, 1994)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
import math

import numpy as np
from numpy.typing import ArrayLike

from tf_transformations.rotations import (
    quaternion_from_matrix,
    quaternion_matrix,
    quaternion_multiply,
    quaternion_slerp,
)
from tf_transformations.vectors import Array, EPSILON, unit_vector


class Arcball:
    """Turns while a button of the mouse is down."""

    def __init__(self, initial: ArrayLike | None = None) -> None:
        """Begin with a rotation.

        :param initial: a quaternion or a 4 x 4 matrix; None: none.
        :raises ValueError: neither.
        """
        begin = np.array((0.0, 0.0, 0.0, 1.0) if initial is None else initial, dtype=np.float64)
        if begin.shape == (4, 4):
            begin = np.array(quaternion_from_matrix(begin))
        elif begin.shape != (4,):
            raise ValueError(f'initial has the shape {begin.shape}: no quaternion and no matrix')
        self._down = self._now = self._before = unit_vector(begin)
        self._pressed = np.array((0.0, 0.0, 1.0))
        self._axes: list[Array] = []
        self._axis: Array | None = None
        self._constrain = False
        self.place((0.0, 0.0), 1.0)

    def place(self, center: Sequence[float], radius: float) -> None:
        """Set where the ball is in the window, y down."""
        self._center = (center[0], center[1])
        self._radius = float(radius)

    def setaxes(self, *axes: ArrayLike) -> None:
        """Set the axes of which one is turned about, where that is asked for."""
        self._axes = [unit_vector(axis) for axis in axes]

    def setconstrain(self, constrain: bool) -> None:
        """Set whether it turns about one of the axes alone."""
        self._constrain = constrain is True

    def getconstrain(self) -> bool:
        return self._constrain

    def down(self, point: Sequence[float]) -> None:
        """Take hold of the ball at a place of the window."""
        self._pressed = arcball_map_to_sphere(point, self._center, self._radius)
        self._down = self._before = self._now
        self._axis = None
        if self._constrain and self._axes:
            self._axis = arcball_nearest_axis(self._pressed, self._axes)
            self._pressed = arcball_constrain_to_axis(self._pressed, self._axis)

    def drag(self, point: Sequence[float]) -> None:
        """Turn the ball so that what is held comes to a place of the window."""
        place = arcball_map_to_sphere(point, self._center, self._radius)
        if self._axis is not None:
            place = arcball_constrain_to_axis(place, self._axis)
        self._before = self._now
        across = np.cross(self._pressed, place)
        if across @ across < EPSILON:
            self._now = self._down
        else:
            turn = (*across.tolist(), float(self._pressed @ place))
            self._now = np.array(quaternion_multiply(turn, self._down))

    def next(self, acceleration: float = 0.0) -> None:
        """Go on turning as in the last drag."""
        ahead = quaternion_slerp(self._before, self._now, 2.0 + acceleration, 0, True)
        self._before, self._now = self._now, ahead

    def matrix(self) -> Array:
        """Return the rotation, 4 x 4."""
        return quaternion_matrix(self._now)


def arcball_map_to_sphere(point: Sequence[float], center: Sequence[float], radius: float) -> Array:
    """Return what of a ball of radius 1 is seen at a place of the window, or is nearest to it."""
    x, y = (point[0] - center[0]) / radius, (center[1] - point[1]) / radius
    square = x * x + y * y
    if square > 1.0:
        return np.array((x, y, 0.0)) / math.sqrt(square)
    return np.array((x, y, math.sqrt(1.0 - square)))


def arcball_constrain_to_axis(point: ArrayLike, axis: ArrayLike) -> Array:
    """Return what is nearest to a point of the ball, at right angles to an axis, and in front."""
    place, pole = np.asarray(point, dtype=np.float64), np.asarray(axis, dtype=np.float64)
    place = place - pole * (pole @ place)
    length = math.sqrt(place @ place)
    if length > EPSILON:
        return place / (-length if place[2] < 0.0 else length)
    return np.array((1.0, 0.0, 0.0)) if pole[2] == 1.0 else unit_vector((-pole[1], pole[0], 0.0))


def arcball_nearest_axis(point: ArrayLike, axes: Iterable[ArrayLike]) -> Array:
    """Return the axis whose circle on the ball is nearest to a point."""
    place = np.asarray(point, dtype=np.float64)
    known = [np.asarray(axis, dtype=np.float64) for axis in axes]
    return max(known, key=lambda axis: float(arcball_constrain_to_axis(place, axis) @ place))
