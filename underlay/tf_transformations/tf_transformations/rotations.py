# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations as quaternions, in the order x, y, z, w of ROS messages."""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np
from numpy.typing import ArrayLike
from transforms3d import affines, euler, quaternions

from tf_transformations.vectors import Array, EPSILON, unit_vector

Quaternion = tuple[float, float, float, float]
Axes = str | tuple[int, int, int, int]
"""Of Euler angles: s (static) or r (rotating) and three of x, y and z; or as a tuple of inner
axis, parity, repetition and frame."""


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = 'sxyz') -> Quaternion:
    """Return the rotation by three angles in rad; by default roll, pitch and yaw."""
    return _from_wxyz(euler.euler2quat(ai, aj, ak, axes=axes))


def euler_from_quaternion(
    quaternion: ArrayLike, axes: Axes = 'sxyz'
) -> tuple[float, float, float]:
    """Return three angles in rad; by default roll, pitch and yaw."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def euler_matrix(ai: float, aj: float, ak: float, axes: Axes = 'sxyz') -> Array:
    """Return the 4 x 4 matrix of the rotation by three angles in rad."""
    return homogeneous(euler.euler2mat(ai, aj, ak, axes=axes))


def euler_from_matrix(matrix: ArrayLike, axes: Axes = 'sxyz') -> tuple[float, float, float]:
    """Return one of the triples of angles in rad that have the rotation of a matrix."""
    roll, pitch, yaw = euler.mat2euler(np.asarray(matrix), axes=axes)
    return float(roll), float(pitch), float(yaw)


def quaternion_about_axis(angle: float, axis: ArrayLike) -> Quaternion:
    """Return the rotation by an angle in rad about an axis."""
    return _from_wxyz(quaternions.axangle2quat(axis, angle))


def quaternion_matrix(quaternion: ArrayLike) -> Array:
    """Return the 4 x 4 matrix of a rotation; of no length at all: no rotation."""
    return homogeneous(quaternions.quat2mat(_to_wxyz(quaternion)))


def quaternion_from_matrix(matrix: ArrayLike) -> Quaternion:
    """Return the rotation in a transformation, of 3 x 3 or 4 x 4 numbers."""
    given = np.asarray(matrix, dtype=np.float64)
    rotation = given if given.shape == (3, 3) else affines.decompose(given)[1]
    return _from_wxyz(quaternions.mat2quat(rotation))


def quaternion_multiply(quaternion1: ArrayLike, quaternion0: ArrayLike) -> Quaternion:
    """Return the rotation by the second one, followed by that of the first."""
    return _from_wxyz(quaternions.qmult(_to_wxyz(quaternion1), _to_wxyz(quaternion0)))


def quaternion_conjugate(quaternion: ArrayLike) -> Array:
    """Return the opposite rotation of a quaternion of length 1."""
    w, x, y, z = _to_wxyz(quaternion)
    return np.array((-x, -y, -z, w), dtype=np.float64)


def quaternion_inverse(quaternion: ArrayLike) -> Array:
    """Return what gives (0, 0, 0, 1) when it is multiplied with the quaternion."""
    conjugate = quaternion_conjugate(quaternion)
    return conjugate / (conjugate @ conjugate)


def quaternion_slerp(
    quat0: ArrayLike,
    quat1: ArrayLike,
    fraction: float,
    spin: int = 0,
    shortestpath: bool = True,
) -> Array:
    """Return what is on the way from one rotation to another, turning evenly (Shoemake 1985).

    :param fraction: of the way: 0 is the first one, 1 the second.
    :param spin: how many half turns more.
    :param shortestpath: not the long way round.
    """
    first, second = (unit_vector(np.asarray(each)[:4]) for each in (quat0, quat1))
    if fraction in (0.0, 1.0):
        return second if fraction else first
    cosine = float(first @ second)
    if abs(abs(cosine) - 1.0) < EPSILON:
        return first
    if shortestpath and cosine < 0.0:
        cosine, second = -cosine, -second
    angle = math.acos(cosine) + spin * math.pi
    if abs(angle) < EPSILON:
        return first
    parts = math.sin((1.0 - fraction) * angle), math.sin(fraction * angle)
    return (parts[0] * first + parts[1] * second) / math.sin(angle)


def random_quaternion(rand: Sequence[float] | None = None) -> Array:
    """Return any rotation, each as likely as another (Shoemake, Graphics Gems III, 1992).

    :param rand: three numbers from 0 to 1 that decide which; None: random ones.
    """
    if rand is not None and len(rand) != 3:
        raise AssertionError(f'rand has {len(rand)} numbers; three are needed')
    share, *turns = np.random.random_sample(3) if rand is None else rand
    one, two = (2.0 * math.pi * turn for turn in turns)
    low, high = math.sqrt(1.0 - share), math.sqrt(share)
    return np.array(
        (low * math.sin(one), low * math.cos(one), high * math.sin(two), high * math.cos(two))
    )


def random_rotation_matrix(rand: Sequence[float] | None = None) -> Array:
    """Return the 4 x 4 matrix of a random rotation, as `random_quaternion` finds it."""
    return quaternion_matrix(random_quaternion(rand))


def homogeneous(rotation: ArrayLike) -> Array:
    """Return the 4 x 4 matrix of a 3 x 3 one."""
    matrix = np.identity(4)
    matrix[:3, :3] = rotation
    return matrix


def _to_wxyz(quaternion: ArrayLike) -> Quaternion:
    """Return a quaternion as transforms3d has it.

    :raises TypeError: it is a message.
    """
    if hasattr(quaternion, 'w'):
        raise TypeError(
            f'a quaternion is four numbers, and this is a {type(quaternion).__name__}: '
            'write [q.x, q.y, q.z, q.w]'
        )
    x, y, z, w = np.asarray(quaternion, dtype=np.float64).tolist()
    return w, x, y, z


def _from_wxyz(quaternion: ArrayLike) -> Quaternion:
    w, x, y, z = np.asarray(quaternion, dtype=np.float64).tolist()
    return x, y, z, w
