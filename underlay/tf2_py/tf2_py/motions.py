# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations and rigid motions on plain tuples: numpy takes longer for so few numbers."""

from __future__ import annotations

import math
from typing import NamedTuple

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]  # x, y, z, w

NO_ROTATION: Quaternion = (0.0, 0.0, 0.0, 1.0)
_NO_NUMBERS: Quaternion = (math.nan, math.nan, math.nan, math.nan)


class Motion(NamedTuple):
    """A rotation, and after it a translation."""

    rotation: Quaternion
    translation: Vector


IDENTITY = Motion(NO_ROTATION, (0.0, 0.0, 0.0))


def multiply(first: Quaternion, second: Quaternion) -> Quaternion:
    """Return the rotation that turns by the second, then by the first."""
    ax, ay, az, aw = first
    bx, by, bz, bw = second
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def conjugate(rotation: Quaternion) -> Quaternion:
    """Return the inverse of a unit quaternion."""
    x, y, z, w = rotation
    return (-x, -y, -z, w)


def rotate(rotation: Quaternion, vector: Vector) -> Vector:
    """Turn a vector by a unit quaternion."""
    x, y, z, _ = multiply(multiply(rotation, (*vector, 0.0)), conjugate(rotation))
    return (x, y, z)


def add(first: Vector, second: Vector) -> Vector:
    return (first[0] + second[0], first[1] + second[1], first[2] + second[2])


def compose(first: Motion, second: Motion) -> Motion:
    """Return the motion that moves by the second, then by the first."""
    return Motion(
        multiply(first.rotation, second.rotation),
        add(rotate(first.rotation, second.translation), first.translation),
    )


def inverse(motion: Motion) -> Motion:
    back = conjugate(motion.rotation)
    x, y, z = motion.translation
    return Motion(back, rotate(back, (-x, -y, -z)))


def interpolate(first: Motion, second: Motion, ratio: float) -> Motion:
    """Return the motion between two: 0 gives the first, 1 the second."""
    rest = 1.0 - ratio
    (ax, ay, az), (bx, by, bz) = first.translation, second.translation
    between = (rest * ax + ratio * bx, rest * ay + ratio * by, rest * az + ratio * bz)
    return Motion(slerp(first.rotation, second.rotation, ratio), between)


def slerp(first: Quaternion, second: Quaternion, ratio: float) -> Quaternion:
    """Interpolate on the shorter arc between two unit quaternions."""
    cosine = sum(a * b for a, b in zip(first, second, strict=True))
    angle = math.acos(min(abs(cosine), 1.0))
    if angle == 0.0:
        return first
    a = math.sin((1.0 - ratio) * angle) / math.sin(angle)
    b = math.copysign(math.sin(ratio * angle) / math.sin(angle), cosine)
    (ax, ay, az, aw), (bx, by, bz, bw) = first, second
    return (a * ax + b * bx, a * ay + b * by, a * az + b * bz, a * aw + b * bw)


def of_angles(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Return the rotation about x, then y, then z, all of them standing still."""
    (sr, cr), (sp, cp), (sy, cy) = (
        (math.sin(0.5 * angle), math.cos(0.5 * angle)) for angle in (roll, pitch, yaw)
    )
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def normalized(rotation: Quaternion) -> Quaternion:
    """Return a unit quaternion; zeros turn by nothing."""
    length = math.hypot(*rotation)
    if length == 0.0:
        return NO_ROTATION
    x, y, z, w = rotation
    return (x / length, y / length, z / length, w / length)


def matrix_of(rotation: Quaternion) -> tuple[Vector, Vector, Vector]:
    """Return the rows of the matrix of a unit quaternion."""
    x, y, z, w = rotation
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)),
        (2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)),
        (2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)),
    )


def as_from_matrix(rotation: Quaternion) -> Quaternion:
    """Return the unit quaternion that tf2 gets where it keeps a rotation as a matrix.

    A quaternion and its negative are the same rotation: of the two it is the one with positive w,
    or with its largest other component positive, where that is a turn by more than 120 degrees.
    Zeros have no such matrix and give nan.
    """
    if not any(rotation):
        return _NO_NUMBERS
    x, y, z, w = normalized(rotation)
    leading = w if abs(w) > 0.5 else max(x, y, z, key=abs)
    return (x, y, z, w) if leading >= 0.0 else (-x, -y, -z, -w)
