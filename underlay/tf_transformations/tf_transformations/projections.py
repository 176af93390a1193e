# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Projections on a plane, and the box that a camera sees."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tf_transformations.vectors import Array, EPSILON, unit_vector

Projection = tuple[Array, Array, Array | None, Array | None, bool]
_NEAR = 1e-8  # of eigenvalues


def projection_matrix(
    point: ArrayLike,
    normal: ArrayLike,
    direction: ArrayLike | None = None,
    perspective: ArrayLike | None = None,
    pseudo: bool = False,
) -> Array:
    """Return the projection on a plane: at right angles, along a direction, or to a point.

    :param point: of the plane.
    :param perspective: the point of view.
    :param pseudo: the distance from the plane is kept, so that the projection at right angles of
        what comes out is the one to the point of view.
    """
    across = unit_vector(np.asarray(normal)[:3])
    distance = float(np.asarray(point, dtype=np.float64)[:3] @ across)  # of the plane
    matrix = np.identity(4)
    if perspective is not None:
        eye = np.asarray(perspective, dtype=np.float64)[:3]
        matrix[:3, :3] *= eye @ across - distance
        matrix[:3, :3] -= np.outer(eye, across)
        matrix[:3, 3] = distance * eye
        if pseudo:
            matrix[:3, :3] -= np.outer(across, across)
            matrix[:3, 3] += distance * across
        matrix[3] = (*-across, eye @ across)
        return matrix
    along = across if direction is None else np.asarray(direction, dtype=np.float64)[:3]
    along = along / (along @ across)
    matrix[:3, :3] -= np.outer(along, across)
    matrix[:3, 3] = distance * along
    return matrix


def projection_from_matrix(matrix: ArrayLike, pseudo: bool = False) -> Projection:
    """Return point, normal, direction, perspective and pseudo, as `projection_matrix` takes them.

    The point has four numbers. The direction of a projection at right angles is the normal.

    :param pseudo: what it was made with: the matrix does not tell.
    :raises ValueError: it is no projection.
    """
    whole = np.array(matrix, dtype=np.float64)
    values, vectors = np.linalg.eig(whole)
    staying = np.flatnonzero(abs(values.real - 1.0) < _NEAR)
    if not pseudo and staying.size:
        point = vectors[:, staying[-1]].real
        _, sizes, directions = np.linalg.svd(whole[:3, :3])
        normals, _, _ = np.linalg.svd(whole[:3, :3])
        if sizes[-1] > _NEAR:
            raise ValueError('no direction of the matrix is projected away')
        return point / point[3], normals[:, -1], directions[-1], None, False
    others = np.flatnonzero(abs(values.real) > _NEAR)
    if not others.size:
        raise ValueError('the matrix leaves nothing of a point')
    point = vectors[:, others[-1]].real
    point = point / point[3]
    normal = -whole[3, :3]
    perspective = whole[:3, 3] / (point[:3] @ normal)
    return point, normal, None, perspective - normal if pseudo else perspective, pseudo


def clip_matrix(
    left: float,
    right: float,
    bottom: float,
    top: float,
    near: float,
    far: float,
    perspective: bool = False,
) -> Array:
    """Return what takes a box to that from -1 to 1 along each axis, with z turned round.

    Two bounds are along each of x, y and z.

    :param perspective: the box is the near end of a frustum whose sides meet at the origin; what
        comes out is to be divided by its fourth number.
    :raises ValueError: a bound is beyond the other, or near is not above 0 in a perspective.
    """
    low, high = np.array((left, bottom, near)), np.array((right, top, far))
    if (low >= high).any():
        raise ValueError('invalid frustum: left < right, bottom < top and near < far are needed')
    size, sums = high - low, high + low
    if not perspective:
        matrix = np.diag((*(2.0 / size), 1.0))
        matrix[:3, 3] = -sums / size
        return matrix
    if near <= EPSILON:
        raise ValueError('invalid frustum: near > 0 is needed')
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[1, 1] = -2.0 * near / size[:2]
    matrix[:3, 2] = (*(sums[:2] / size[:2]), -sums[2] / size[2])
    matrix[2, 3] = 2.0 * near * far / size[2]
    matrix[3, 2] = -1.0
    return matrix
