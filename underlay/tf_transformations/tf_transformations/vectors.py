# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Lengths and directions of vectors."""

from __future__ import annotations

from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
EPSILON = 4.0 * float(np.finfo(np.float64).eps)
"""What is nearer to zero is zero."""


@overload
def vector_norm(data: ArrayLike, axis: int | None = None, out: None = None) -> Any: ...
@overload
def vector_norm(data: ArrayLike, axis: int | None = None, *, out: Array) -> None: ...
def vector_norm(
    data: ArrayLike, axis: int | None = None, out: Array | None = None
) -> float | Array | None:
    """Return the length of a vector, or an array of those along an axis.

    :param out: takes the result, and None is returned.
    """
    vectors = np.asarray(data, dtype=np.float64)
    if out is not None:
        out[...] = np.sqrt((vectors * vectors).sum(axis=axis))
        return None
    if vectors.ndim == 1:
        return float(np.sqrt(vectors @ vectors))
    return np.atleast_1d(np.sqrt((vectors * vectors).sum(axis=axis)))


@overload
def unit_vector(data: ArrayLike, axis: int | None = None, out: None = None) -> Array: ...
@overload
def unit_vector(data: ArrayLike, axis: int | None = None, *, out: Array) -> None: ...
def unit_vector(
    data: ArrayLike, axis: int | None = None, out: Array | None = None
) -> Array | None:
    """Return a vector of length 1 with the direction of another, or those along an axis.

    :param out: takes the result, may be `data` itself, and None is returned.
    """
    vectors = np.array(data, dtype=np.float64)
    squares = (vectors * vectors).sum(axis=axis, keepdims=axis is not None)
    vectors /= np.sqrt(squares)
    if out is None:
        return vectors
    out[...] = vectors
    return None


def random_vector(size: int | tuple[int, ...]) -> Array:
    """Return numbers that are evenly distributed from 0 to 1, without 1."""
    return np.random.random_sample(size)
