# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The numbers of a lookup, against an independent computation with matrices."""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import TransformStamped
from hypothesis import given, strategies
import numpy as np
from numpy.typing import NDArray
from playpen_testing.transforms import buffer_of, LATEST, seconds, transform
import pytest
from tf2_py import BufferCore

Matrix = NDArray[np.float64]

unit_quaternions = (
    strategies.tuples(*[strategies.floats(-1.0, 1.0)] * 4)
    .filter(lambda q: math.hypot(*q) > 0.1)
    .map(lambda q: tuple(component / math.hypot(*q) for component in q))
)
motions = strategies.tuples(
    strategies.tuples(*[strategies.floats(-100.0, 100.0)] * 3), unit_quaternions
)


def matrix(translation: tuple[float, ...], rotation: tuple[float, ...]) -> Matrix:
    """Return the motion by Rodrigues' formula, which tf2 does not use."""
    axis, w = np.array(rotation[:3]), rotation[3]
    sine = float(np.linalg.norm(axis))
    angle = 2.0 * math.atan2(sine, w)
    x, y, z = axis / sine if sine > 0.0 else axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    whole = np.eye(4)
    whole[:3, :3] += math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    whole[:3, 3] = translation
    return whole


def matrix_of(message: TransformStamped) -> Matrix:
    to, turn = message.transform.translation, message.transform.rotation
    return matrix((to.x, to.y, to.z), (turn.x, turn.y, turn.z, turn.w))


@given(strategies.lists(motions, min_size=1, max_size=4), strategies.lists(motions, max_size=4))
def test_a_lookup_is_the_product_of_matrices(
    up: list[tuple[Any, Any]], down: list[tuple[Any, Any]]
) -> None:
    buffer = BufferCore()
    ends = []
    for branch, steps in (('s', up), ('t', down)):
        parent, product = 'root', np.eye(4)
        for number, (translation, rotation) in enumerate(steps):
            child = f'{branch}{number}'
            buffer.set_transform_static(
                transform(parent, child, 0.0, translation, rotation), 'test'
            )
            product = product @ matrix(translation, rotation)
            parent = child
        ends.append((parent, product))
    (source, from_source), (target, from_target) = ends
    found = matrix_of(buffer.lookup_transform_core(target, source, LATEST))
    assert np.allclose(found, np.linalg.inv(from_target) @ from_source, atol=1e-9, rtol=1e-9)


@given(motions, motions, strategies.floats(0.0, 1.0))
def test_between_two_times_it_turns_evenly_on_the_shorter_arc(
    first: tuple[Any, Any], second: tuple[Any, Any], ratio: float
) -> None:
    buffer = buffer_of(transform('a', 'b', 10.0, *first), transform('a', 'b', 12.0, *second))
    asked = seconds(10.0 + 2.0 * ratio)
    ratio = (asked.nanoseconds - 10 * 10**9) / (2 * 10**9)
    found = matrix_of(buffer.lookup_transform_core('a', 'b', asked))
    start, end = matrix(*first), matrix(*second)
    assert np.allclose(found[:3, 3], (1.0 - ratio) * start[:3, 3] + ratio * end[:3, 3], atol=1e-9)
    turned, whole = (_angle(start[:3, :3].T @ turn[:3, :3]) for turn in (found, end))
    assert turned == pytest.approx(ratio * whole, abs=1e-6)
    rest = _angle(found[:3, :3].T @ end[:3, :3])
    assert turned + rest == pytest.approx(whole, abs=1e-6)


def _angle(rotation: Matrix) -> float:
    off = rotation - rotation.T
    sine = 0.5 * math.hypot(off[2, 1], off[0, 2], off[1, 0])
    return math.atan2(sine, 0.5 * (float(np.trace(rotation)) - 1.0))


@given(unit_quaternions, strategies.floats(0.1, 9.0))
def test_a_quaternion_of_another_length_is_the_same_rotation(
    rotation: tuple[float, ...], length: float
) -> None:
    stretched = tuple(length * component for component in rotation)
    buffer = buffer_of(transform('a', 'b', 1.0, rotation=stretched))
    turn = buffer.lookup_transform_core('a', 'b', LATEST).transform.rotation
    assert math.hypot(turn.x, turn.y, turn.z, turn.w) == pytest.approx(1.0)
    assert np.allclose(
        matrix((0, 0, 0), (turn.x, turn.y, turn.z, turn.w)), matrix((0, 0, 0), rotation)
    )


@pytest.mark.parametrize(
    ('sent', 'found'),
    [
        ((0.0, 0.0, 0.6, -0.8), (0.0, 0.0, -0.6, 0.8)),  # w becomes positive
        ((0.0, 0.0, -1.0, 0.0), (0.0, 0.0, 1.0, 0.0)),  # half a turn has no w
        ((0.8, 0.0, -0.5, -math.sqrt(0.11)), (0.8, 0.0, -0.5, -math.sqrt(0.11))),
    ],
)
def test_of_two_equal_quaternions_it_is_the_one_of_tf2(
    sent: tuple[float, ...], found: tuple[float, ...]
) -> None:
    buffer = buffer_of(transform('a', 'b', 1.0, rotation=sent))
    turn = buffer.lookup_transform_core('a', 'b', LATEST).transform.rotation
    assert (turn.x, turn.y, turn.z, turn.w) == pytest.approx(found)
