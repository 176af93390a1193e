# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Transformations as 4 x 4 matrices, which columns of x, y, z, 1 are multiplied with."""

from __future__ import annotations

from collections.abc import Sequence
import functools

import numpy as np
from numpy.typing import ArrayLike
from transforms3d import affines, axangles, euler, quaternions, reflections, shears, zooms

from tf_transformations.rotations import euler_from_matrix, homogeneous
from tf_transformations.vectors import Array, EPSILON

TRANSLATION_IDENTITY = [0.0, 0.0, 0.0]
ROTATION_IDENTITY = np.identity(3)
ZOOM_IDENTITY = [1.0, 1.0, 1.0]
SHEAR_IDENTITY = TRANSLATION_IDENTITY

Decomposed = tuple[Array, Array, tuple[float, float, float], Array, Array | None]


def identity_matrix() -> Array:
    """Return the matrix that changes nothing."""
    return np.identity(4)


def translation_matrix(direction: ArrayLike) -> Array:
    """Return the matrix that moves by a vector."""
    matrix = np.identity(4)
    matrix[:3, 3] = np.asarray(direction, dtype=np.float64)[:3]
    return matrix


def translation_from_matrix(matrix: ArrayLike) -> Array:
    """Return the vector by which a matrix moves the origin."""
    return np.array(matrix, dtype=np.float64)[:3, 3]


def rotation_matrix(angle: float, direction: ArrayLike, point: ArrayLike | None = None) -> Array:
    """Return the rotation by an angle in rad about an axis, which goes through a point.

    :param point: None: the origin.
    """
    axis = np.asarray(direction, dtype=np.float64)[:3]
    return np.asarray(axangles.axangle2aff(axis, angle, point=_of_3(point)))


def rotation_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array]:
    """Return angle in rad, axis and a point on it.

    :raises ValueError: it is no rotation.
    """
    direction, angle, point = axangles.aff2axangle(np.asarray(matrix, dtype=np.float64))
    return float(angle), direction, point


def reflection_matrix(point: ArrayLike, normal: ArrayLike) -> Array:
    """Return the mirror image at a plane."""
    across = np.asarray(normal, dtype=np.float64)[:3]
    return np.asarray(reflections.rfnorm2aff(across, _of_3(point)))


def reflection_from_matrix(matrix: ArrayLike) -> tuple[Array, Array]:
    """Return a point and the normal of the plane.

    :raises ValueError: it is no reflection.
    """
    normal, point = reflections.aff2rfnorm(np.asarray(matrix, dtype=np.float64))
    return point, normal


def scale_matrix(
    factor: float, origin: ArrayLike | None = None, direction: ArrayLike | None = None
) -> Array:
    """Return what stretches everything away from a point.

    :param origin: the point that stays; None: the origin.
    :param direction: in which alone it stretches; None: in all.
    """
    return np.asarray(zooms.zfdir2aff(factor, direction=_of_3(direction), origin=_of_3(origin)))


def scale_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array | None]:
    """Return factor, origin and direction; that is None where it stretches in all.

    :raises ValueError: it does not stretch.
    """
    factor, direction, origin = zooms.aff2zfdir(np.asarray(matrix, dtype=np.float64))
    return float(factor), origin, direction


def shear_matrix(angle: float, direction: ArrayLike, point: ArrayLike, normal: ArrayLike) -> Array:
    """Return what moves places along a plane, the further the higher they are above it.

    :param angle: in rad; its tangent is the way for each metre above the plane.
    :param direction: at right angles to the normal of the plane.
    """
    along, across = (np.asarray(each, dtype=np.float64)[:3] for each in (direction, normal))
    return np.asarray(shears.sadn2aff(angle, along, across, _of_3(point)))


def shear_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array, Array]:
    """Return angle, direction, a point of the plane, and its normal.

    :raises ValueError: it is no shear.
    """
    angle, direction, normal, point = shears.aff2sadn(np.asarray(matrix, dtype=np.float64))
    return float(angle), direction, point, normal


def compose_matrix(
    scale: ArrayLike | None = None,
    shear: ArrayLike | None = None,
    angles: Sequence[float] | None = None,
    translate: ArrayLike | None = None,
    perspective: ArrayLike | None = None,
) -> Array:
    """Return the matrix that scales, shears, rotates, moves and projects, in this order.

    :param scale: along x, y and z.
    :param shear: x by y, x by z, y by z.
    :param angles: in rad about the axes x, y and z, which stand.
    :param perspective: the last row of a projection.
    """
    matrix = affines.compose(
        TRANSLATION_IDENTITY if translate is None else translate,
        ROTATION_IDENTITY if angles is None else euler.euler2mat(*angles),
        ZOOM_IDENTITY if scale is None else scale,
        SHEAR_IDENTITY if shear is None else shear,
    )
    if perspective is None:
        return np.asarray(matrix)
    projection = np.identity(4)
    projection[3] = perspective
    return projection @ matrix


def decompose_matrix(matrix: ArrayLike) -> Decomposed:
    """Return scale, shear, angles, translation and perspective: the inverse of `compose_matrix`.

    The perspective is None where there is none.

    :raises ValueError: the matrix has no inverse.
    """
    whole = np.array(matrix, dtype=np.float64)
    if abs(whole[3, 3]) < EPSILON:
        raise ValueError('the last number of the matrix is 0')
    affine = whole.copy()
    affine[3] = (0.0, 0.0, 0.0, 1.0)
    if abs(np.linalg.det(affine)) < EPSILON:
        raise ValueError('the matrix has no inverse')
    perspective = None
    if not np.allclose(whole[3], affine[3], rtol=0.0, atol=EPSILON):
        perspective = whole[3] @ np.linalg.inv(affine)
    translate, rotation, scale, shear = affines.decompose(affine)
    return scale, shear, euler_from_matrix(rotation), translate, perspective


def inverse_matrix(matrix: ArrayLike) -> Array:
    """Return the matrix that takes back what another one does."""
    return np.linalg.inv(np.asarray(matrix, dtype=np.float64))


def concatenate_matrices(*matrices: ArrayLike) -> Array:
    """Return the product of matrices: the last one acts first."""
    return functools.reduce(np.dot, map(np.asarray, matrices), np.identity(4))


def is_same_transform(matrix0: ArrayLike, matrix1: ArrayLike) -> bool:
    """Tell whether two matrices do the same, each of them in its own scale."""
    first, second = (np.array(each, dtype=np.float64) for each in (matrix0, matrix1))
    return bool(np.allclose(first / first[3, 3], second / second[3, 3]))


def orthogonalization_matrix(lengths: Sequence[float], angles: Sequence[float]) -> Array:
    """Return what takes coordinates along the edges of a crystal's cell to Cartesian ones.

    :param lengths: of the edges a, b and c.
    :param angles: in degrees, between b and c, a and c, a and b.
    """
    a, b, c = lengths
    cos_bc, cos_ac, cos_ab = np.cos(np.radians(angles))
    sin_bc, sin_ac, _ = np.sin(np.radians(angles))
    reciprocal = (cos_bc * cos_ac - cos_ab) / (sin_bc * sin_ac)
    # The edge c is along z, b in the plane of y and z.
    return homogeneous(
        (
            (a * sin_ac * np.sqrt(1.0 - reciprocal * reciprocal), 0.0, 0.0),
            (-a * sin_ac * reciprocal, b * sin_bc, 0.0),
            (a * cos_ac, b * cos_bc, c),
        )
    )


def superimposition_matrix(
    v0: ArrayLike, v1: ArrayLike, scaling: bool = False, usesvd: bool = True
) -> Array:
    """Return the rotation and translation that bring points nearest to others.

    :param v0: the points, (3, n) or (4, n), n at least 3; `v1` are those that they should meet.
    :param scaling: stretch, too.
    :param usesvd: by the algorithm of Kabsch (1976), else by that of Horn (1987).
    :raises ValueError: other shapes.
    """
    first, second = (np.array(each, dtype=np.float64)[:3] for each in (v0, v1))
    if first.shape != second.shape or first.ndim != 2 or first.shape[1] < 3:
        raise ValueError(
            f'points of shape {first.shape} and {second.shape}: both need the same, three numbers '
            'of at least three points'
        )
    centers = first.mean(axis=1), second.mean(axis=1)
    first, second = first - centers[0][:, None], second - centers[1][:, None]
    rotation = _rotation_by_kabsch(first, second) if usesvd else _rotation_by_horn(first, second)
    if scaling:
        rotation = rotation * np.sqrt((second * second).sum() / (first * first).sum())
    matrix = homogeneous(rotation)
    matrix[:3, 3] = centers[1] - rotation @ centers[0]
    return matrix


def _rotation_by_kabsch(first: Array, second: Array) -> Array:
    left, _, right = np.linalg.svd(second @ first.T)
    sign = np.sign(np.linalg.det(left) * np.linalg.det(right))  # -1: it would be a mirror image
    return (left * (1.0, 1.0, sign)) @ right


def _rotation_by_horn(first: Array, second: Array) -> Array:
    sums = first @ second.T
    cross = np.array((sums[1, 2] - sums[2, 1], sums[2, 0] - sums[0, 2], sums[0, 1] - sums[1, 0]))
    symmetric = np.empty((4, 4))
    symmetric[0, 0] = np.trace(sums)
    symmetric[0, 1:] = symmetric[1:, 0] = cross
    symmetric[1:, 1:] = sums + sums.T - np.trace(sums) * np.identity(3)
    _, vectors = np.linalg.eigh(symmetric)
    return np.asarray(quaternions.quat2mat(vectors[:, -1]))  # of the greatest eigenvalue


def _of_3(vector: ArrayLike | None) -> Array | None:
    """Return the first three numbers of a vector that may have a fourth one."""
    return None if vector is None else np.asarray(vector, dtype=np.float64)[:3]
