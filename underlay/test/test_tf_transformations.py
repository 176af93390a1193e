# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Quaternions, Euler angles and matrices, as nodes of ROS 1 and of Jazzy reckon with them."""

from __future__ import annotations

from collections.abc import Callable
import inspect
import itertools
import math
from typing import Any

from geometry_msgs.msg import Quaternion
import numpy as np
from numpy.typing import NDArray
import pytest
import tf_transformations as tft

Array = NDArray[np.float64]
HALF = math.sqrt(0.5)
AXES = [
    frame + ''.join(axes)
    for frame in 'sr'
    for axes in itertools.product('xyz', repeat=3)
    if axes[0] != axes[1] != axes[2]
]
ENCODED = list(itertools.product((0, 1, 2), (0, 1), (0, 1), (0, 1)))

# Of tf_transformations 1.1.1, the parameters by their names.
INTERFACE = """
arcball_constrain_to_axis(point, axis) arcball_map_to_sphere(point, center, radius)
arcball_nearest_axis(point, axes)
clip_matrix(left, right, bottom, top, near, far, perspective=False)
compose_matrix(scale=None, shear=None, angles=None, translate=None, perspective=None)
concatenate_matrices(*matrices) decompose_matrix(matrix)
euler_from_matrix(matrix, axes='sxyz') euler_from_quaternion(quaternion, axes='sxyz')
euler_matrix(ai, aj, ak, axes='sxyz') identity_matrix() inverse_matrix(matrix)
is_same_transform(matrix0, matrix1) orthogonalization_matrix(lengths, angles)
projection_from_matrix(matrix, pseudo=False)
projection_matrix(point, normal, direction=None, perspective=None, pseudo=False)
quaternion_about_axis(angle, axis) quaternion_conjugate(quaternion)
quaternion_from_euler(ai, aj, ak, axes='sxyz') quaternion_from_matrix(matrix)
quaternion_inverse(quaternion) quaternion_matrix(quaternion)
quaternion_multiply(quaternion1, quaternion0)
quaternion_slerp(quat0, quat1, fraction, spin=0, shortestpath=True)
random_quaternion(rand=None) random_rotation_matrix(rand=None) random_vector(size)
reflection_from_matrix(matrix) reflection_matrix(point, normal)
rotation_from_matrix(matrix) rotation_matrix(angle, direction, point=None)
scale_from_matrix(matrix) scale_matrix(factor, origin=None, direction=None)
shear_from_matrix(matrix) shear_matrix(angle, direction, point, normal)
superimposition_matrix(v0, v1, scaling=False, usesvd=True)
translation_from_matrix(matrix) translation_matrix(direction)
unit_vector(data, axis=None, out=None) vector_norm(data, axis=None, out=None)
"""


@pytest.fixture
def numbers() -> np.random.Generator:
    return np.random.default_rng(7)


def directions(numbers: np.random.Generator, count: int) -> list[Array]:
    return list(numbers.uniform(-1.0, 1.0, (count, 3)))


def moved(matrix: Array, point: Any) -> Array:
    """Return where a matrix takes a point."""
    result = matrix @ (*point, 1.0)
    return result[:3] / result[3]


def test_it_has_what_upstream_has() -> None:
    has = {
        f'{name}({", ".join(str(each).split(":")[0] for each in _bare(value))})'
        for name, value in vars(tft).items()
        if inspect.isfunction(value)
    }
    wanted = {f'{line})' for line in ' '.join(INTERFACE.split()).removesuffix(')').split(') ')}
    assert has == wanted
    assert {'Arcball', 'ROTATION_IDENTITY', 'SHEAR_IDENTITY'} < set(tft.__all__)
    assert {'TRANSLATION_IDENTITY', 'ZOOM_IDENTITY'} < set(tft.__all__)


def _bare(function: Any) -> list[inspect.Parameter]:
    given = inspect.signature(function).parameters.values()
    return [each.replace(annotation=inspect.Parameter.empty) for each in given]


def test_roll_pitch_and_yaw_are_those_of_rep_103() -> None:
    """With x forward, y left, z up, the angles about the axes that stand, w last."""
    assert tft.quaternion_from_euler(0.0, 0.0, math.pi / 2) == pytest.approx((0, 0, HALF, HALF))
    assert tft.quaternion_from_euler(math.pi / 2, 0.0, 0.0) == pytest.approx((HALF, 0, 0, HALF))
    forward = moved(tft.quaternion_matrix(tft.quaternion_from_euler(0.0, 0.0, 0.3)), (1, 0, 0))
    assert forward == pytest.approx((math.cos(0.3), math.sin(0.3), 0.0))
    assert tft.euler_from_quaternion((0.0, 0.0, 0.0, 1.0)) == (0.0, 0.0, 0.0)
    assert tft.euler_from_quaternion([0.1, 0.2, 0.3, 0.9]) == pytest.approx(
        tft.euler_from_quaternion([-0.1, -0.2, -0.3, -0.9])
    )


def test_numbers_that_the_library_of_gohlke_documents() -> None:
    def near(*wanted: float) -> Any:
        return pytest.approx(wanted, abs=1e-6)

    assert tft.quaternion_from_euler(1, 2, 3, 'ryxz') == near(
        0.310622, -0.718287, 0.444435, 0.435953
    )
    assert tft.euler_matrix(1, 2, 3, 'syxz')[0].sum() == pytest.approx(-1.34786452)
    assert tft.euler_matrix(1, 2, 3, (0, 1, 0, 1))[0].sum() == pytest.approx(-0.383436184)
    assert tft.quaternion_about_axis(0.123, (1, 0, 0)) == near(0.06146124, 0, 0, 0.99810947)
    assert tft.quaternion_multiply([1, -2, 3, 4], [-5, 6, 7, 8]) == near(-44, -14, 48, 28)
    cell = tft.orthogonalization_matrix([9.8, 12.0, 15.5], [87.2, 80.7, 69.7])
    assert cell.sum() == pytest.approx(43.063229)


@pytest.mark.parametrize('axes', [*AXES, *ENCODED], ids=str)
def test_angles_come_back_about_all_axes(numbers: np.random.Generator, axes: Any) -> None:
    for ai, aj, ak in numbers.uniform(-3.0, 3.0, (20, 3)).tolist():
        quaternion = tft.quaternion_from_euler(ai, aj, ak, axes)
        matrix = tft.euler_matrix(ai, aj, ak, axes)
        assert tft.is_same_transform(matrix, tft.quaternion_matrix(quaternion))
        for back in (
            tft.euler_from_matrix(matrix, axes),
            tft.euler_from_quaternion(quaternion, axes),
        ):
            assert tft.is_same_transform(matrix, tft.euler_matrix(*back, axes))


@pytest.mark.parametrize('pitch', [math.pi / 2, -math.pi / 2])
def test_angles_where_two_axes_are_one(pitch: float) -> None:
    matrix = tft.euler_matrix(0.3, pitch, 0.2)
    back = tft.euler_from_matrix(matrix)
    assert back[1] == pytest.approx(pitch)
    assert tft.is_same_transform(matrix, tft.euler_matrix(*back))


def test_a_quaternion_that_is_a_message_is_refused() -> None:
    with pytest.raises(TypeError, match=r'this is a Quaternion: write \[q.x, q.y, q.z, q.w\]'):
        tft.euler_from_quaternion(Quaternion(w=1.0))
    roll, pitch, yaw = tft.euler_from_quaternion([0.0, 0.0, 0.0, 0.0])  # of an empty message
    assert (roll, pitch, yaw) == (0.0, 0.0, 0.0)
    x, y, z, w = tft.quaternion_from_euler(0.1, 0.2, 0.3)
    Quaternion(x=x, y=y, z=z, w=w)


def test_rotations_follow_each_other(numbers: np.random.Generator) -> None:
    for _ in range(20):
        first, second = tft.random_quaternion(), tft.random_quaternion()
        both = tft.quaternion_multiply(second, first)
        matrix = tft.quaternion_matrix(second) @ tft.quaternion_matrix(first)
        assert tft.is_same_transform(tft.quaternion_matrix(both), matrix)
        assert tft.is_same_transform(
            matrix, tft.quaternion_matrix(tft.quaternion_from_matrix(matrix))
        )
        assert tft.quaternion_from_matrix(matrix[:3, :3]) == pytest.approx(
            tft.quaternion_from_matrix(matrix)
        )
        length = numbers.uniform(0.1, 3.0)
        unit = tft.quaternion_multiply(first * length, tft.quaternion_inverse(first * length))
        assert unit == pytest.approx((0.0, 0.0, 0.0, 1.0))
        assert tft.quaternion_conjugate(first) == pytest.approx(tft.quaternion_inverse(first))


def test_a_way_between_two_rotations_turns_evenly() -> None:
    start, end = ((0.0, 0.0, math.sin(a / 2), math.cos(a / 2)) for a in (0.2, 1.4))
    for fraction in (0.0, 0.25, 0.5, 1.0):
        yaw = tft.euler_from_quaternion(tft.quaternion_slerp(start, end, fraction))[2]
        assert yaw == pytest.approx(0.2 + 1.2 * fraction)
    opposite = tuple(-each for each in end)  # the same rotation
    for fraction in (0.25, 0.5):
        part = tft.quaternion_slerp(start, opposite, fraction)
        assert np.linalg.norm(part) == pytest.approx(1.0)
        assert tft.euler_from_quaternion(part)[2] == pytest.approx(0.2 + 1.2 * fraction)
    long = tft.quaternion_slerp(start, opposite, 0.5, shortestpath=False)
    assert tft.euler_from_quaternion(long)[2] == pytest.approx(0.8 - math.pi)
    once_round = tft.quaternion_slerp(start, end, 0.5, spin=2)
    assert once_round == pytest.approx(-tft.quaternion_slerp(start, end, 0.5))
    assert tft.quaternion_slerp(start, start, 0.7) == pytest.approx(start)


def test_random_rotations_take_a_direction_anywhere() -> None:
    turned = np.array([tft.random_rotation_matrix()[:3, 0] for _ in range(2000)])
    assert np.abs(turned.mean(axis=0)).max() < 0.08  # four sigma
    assert (turned**2).mean(axis=0) == pytest.approx((1 / 3, 1 / 3, 1 / 3), abs=0.03)
    by_upstream = (0.850650808, -0.276393202, 0.262865556, -0.361803399)
    assert tft.random_quaternion((0.2, 0.3, 0.4)) == pytest.approx(by_upstream)
    assert tft.random_rotation_matrix((0.2, 0.3, 0.4)) == pytest.approx(
        tft.quaternion_matrix(by_upstream)
    )
    with pytest.raises(AssertionError, match='three are needed'):
        tft.random_quaternion([0.1])


def test_matrices_say_what_they_were_made_of(numbers: np.random.Generator) -> None:
    for _ in range(20):
        point, normal, other = directions(numbers, 3)
        angle, factor = numbers.uniform(0.1, 3.0, 2)
        along = np.cross(normal, other)
        for matrix, read, make in (
            (
                tft.rotation_matrix(angle, normal, point),
                tft.rotation_from_matrix,
                tft.rotation_matrix,
            ),
            (tft.reflection_matrix(point, normal), tft.reflection_from_matrix, None),
            (tft.scale_matrix(factor, point), tft.scale_from_matrix, tft.scale_matrix),
            (tft.scale_matrix(factor, point, normal), tft.scale_from_matrix, tft.scale_matrix),
            (tft.shear_matrix(0.4, along, point, normal), tft.shear_from_matrix, tft.shear_matrix),
        ):
            again = (make or tft.reflection_matrix)(*read(matrix))  # type: ignore[operator]
            assert tft.is_same_transform(matrix, again), read
        matrix = tft.translation_matrix(point)
        assert tft.translation_from_matrix(matrix) == pytest.approx(point)
        assert moved(matrix, other) == pytest.approx(point + other)


def test_matrices_move_points_as_they_should(numbers: np.random.Generator) -> None:
    point, normal, other = directions(numbers, 3)
    unit = tft.unit_vector(normal)
    mirrored = moved(tft.reflection_matrix(point, normal), other)
    assert (mirrored + other - 2 * point) @ unit == pytest.approx(0.0)
    assert np.cross(mirrored - other, unit) == pytest.approx((0, 0, 0))
    assert moved(tft.scale_matrix(-2.0, point), other) == pytest.approx(3 * point - 2 * other)
    turned = moved(tft.rotation_matrix(math.pi, normal, point), other)
    assert (turned - other) @ unit == pytest.approx(0.0)
    along = np.cross(normal, other)
    pushed = moved(tft.shear_matrix(0.4, along, point, normal), other)
    assert pushed - other == pytest.approx(
        math.tan(0.4) * ((other - point) @ unit) * tft.unit_vector(along)
    )


def test_a_matrix_is_taken_apart(numbers: np.random.Generator) -> None:
    for perspective in (None, (0.1, -0.2, 0.3, 1.5)):
        scale, shear = numbers.uniform(0.2, 2.0, (2, 3))
        angles, translate = numbers.uniform(-1.5, 1.5, (2, 3))
        matrix = tft.compose_matrix(scale, shear, angles, translate, perspective)
        parts = tft.decompose_matrix(matrix)
        for part, wanted in zip(parts, (scale, shear, angles, translate), strict=False):
            assert part == pytest.approx(wanted)
        assert (parts[4] is None) is (perspective is None)
        assert matrix == pytest.approx(tft.compose_matrix(*parts))
        assert tft.inverse_matrix(matrix) @ matrix == pytest.approx(tft.identity_matrix())
    assert tft.compose_matrix() == pytest.approx(tft.identity_matrix())
    for singular in (np.zeros((4, 4)), np.diag((1.0, 0.0, 1.0, 1.0))):
        with pytest.raises(ValueError, match='matrix'):
            tft.decompose_matrix(singular)


def test_the_last_of_several_matrices_acts_first() -> None:
    both = tft.concatenate_matrices(
        tft.translation_matrix((1, 0, 0)), tft.rotation_matrix(math.pi / 2, (0, 0, 1))
    )
    assert moved(both, (1, 0, 0)) == pytest.approx((1, 1, 0))
    assert tft.concatenate_matrices() == pytest.approx(tft.identity_matrix())
    assert tft.is_same_transform(both, 2.0 * both)
    assert not tft.is_same_transform(both, tft.identity_matrix())


def test_projections_end_on_the_plane(numbers: np.random.Generator) -> None:
    point, normal, aside, eye = directions(numbers, 4)
    unit = tft.unit_vector(normal)
    ways: list[tuple[dict[str, Any], Callable[[Array], Array]]] = [
        ({}, lambda _: normal),
        ({'direction': aside}, lambda _: aside),
        ({'perspective': eye}, lambda place: place - eye),
    ]
    for how, ahead in ways:
        matrix = tft.projection_matrix(point, normal, **how)
        for place in directions(numbers, 5):
            seen = moved(matrix, place)
            assert (seen - point) @ unit == pytest.approx(0.0, abs=1e-9)
            assert np.cross(seen - place, ahead(place)) == pytest.approx((0, 0, 0), abs=1e-9)
        again = tft.projection_matrix(*tft.projection_from_matrix(matrix))
        assert tft.is_same_transform(matrix, again)
    flat = tft.projection_matrix(point, normal)
    deep = tft.projection_matrix(point, normal, perspective=eye, pseudo=True)
    assert tft.is_same_transform(flat @ deep, tft.projection_matrix(point, normal, None, eye))
    again = tft.projection_matrix(*tft.projection_from_matrix(deep, pseudo=True))
    assert tft.is_same_transform(deep, again)
    with pytest.raises(ValueError, match='projected away'):
        tft.projection_from_matrix(tft.identity_matrix())


def test_what_a_camera_sees_fills_a_cube() -> None:
    box = (-1.0, 3.0, -2.0, 1.0, 2.0, 6.0)
    flat = tft.clip_matrix(*box)
    assert moved(flat, (-1, -2, 2)) == pytest.approx((-1, -1, -1))
    assert moved(flat, (3, 1, 6)) == pytest.approx((1, 1, 1))
    deep = tft.clip_matrix(*box, perspective=True)
    # The matrix of glFrustum with the sign of x and y as it is in the library of Gohlke.
    assert moved(deep, (-1, -2, 2)) == pytest.approx((-1, -1, -1))
    assert moved(deep, (9, 3, 6)) == pytest.approx((1, 1, 1))
    for wrong in ((1.0, 1.0, 0.0, 1.0, 0.0, 1.0), (0.0, 1.0, 2.0, 1.0, 0.0, 1.0)):
        with pytest.raises(ValueError, match='left < right'):
            tft.clip_matrix(*wrong)
    with pytest.raises(ValueError, match='near > 0'):
        tft.clip_matrix(0, 1, 0, 1, 0, 1, perspective=True)


@pytest.mark.parametrize('usesvd', [True, False])
@pytest.mark.parametrize('rows', [3, 4])
def test_points_are_brought_to_others(
    numbers: np.random.Generator, usesvd: bool, rows: int
) -> None:
    before = np.ones((rows, 10))
    before[:3] = numbers.uniform(-5.0, 5.0, (3, 10))
    motion = tft.rotation_matrix(2.0, (1, 2, 3), (4, 5, 6))
    for matrix, scaling in ((motion, False), (motion @ tft.scale_matrix(0.4), True)):
        after = (matrix @ np.vstack((before[:3], np.ones(10))))[:rows]
        found = tft.superimposition_matrix(before, after, scaling=scaling, usesvd=usesvd)
        assert found == pytest.approx(matrix)
        noisy = after[:3] + numbers.normal(0.0, 0.01, (3, 10))
        found = tft.superimposition_matrix(before[:3], noisy, scaling=scaling, usesvd=usesvd)
        assert found == pytest.approx(matrix, abs=0.05)
        assert np.linalg.det(found) > 0.0
    with pytest.raises(ValueError, match='points of shape'):
        tft.superimposition_matrix(before[:, :2], before[:, :2], usesvd=usesvd)


def test_lengths_and_directions(numbers: np.random.Generator) -> None:
    vectors = tft.random_vector((4, 3))
    assert ((vectors >= 0.0) & (vectors < 1.0)).all()
    assert tft.vector_norm([3.0, 4.0]) == 5.0
    assert tft.vector_norm([]) == 0.0
    for axis in (0, 1):
        wanted = np.linalg.norm(vectors, axis=axis)
        assert tft.vector_norm(vectors, axis=axis) == pytest.approx(wanted)
        lengths, units = np.full_like(wanted, np.nan), vectors.copy()
        assert tft.vector_norm(vectors, axis=axis, out=lengths) is None
        assert lengths == pytest.approx(wanted)
        assert tft.unit_vector(units, axis=axis, out=units) is None
        assert np.linalg.norm(units, axis=axis) == pytest.approx(np.ones_like(wanted))
        assert units == pytest.approx(tft.unit_vector(vectors, axis=axis))
    assert tft.unit_vector([0, 3, 4]) == pytest.approx((0.0, 0.6, 0.8))
    assert list(tft.unit_vector([])) == []


def test_a_ball_turns_with_the_mouse() -> None:
    ball = tft.Arcball()
    ball.place((100, 100), 50)
    ball.down((100, 100))
    ball.drag((150, 100))  # from the middle to the right edge: a quarter, doubled
    assert ball.matrix() == pytest.approx(tft.rotation_matrix(math.pi, (0, 1, 0)))
    ball.drag((100, 100))
    assert ball.matrix() == pytest.approx(tft.identity_matrix())
    ball.drag((110, 100))
    ball.drag((120, 100))
    first, second = (2 * math.asin(x) for x in (0.2, 0.4))
    assert tft.rotation_from_matrix(ball.matrix())[0] == pytest.approx(second)
    ball.next()
    assert tft.rotation_from_matrix(ball.matrix())[0] == pytest.approx(2 * second - first)

    held = tft.Arcball(initial=tft.rotation_matrix(0.5, (0, 0, 1)))
    held.place((0, 0), 1)
    held.setaxes((1, 0, 0), (0, 0, 1))
    held.setconstrain(True)
    assert held.getconstrain()
    held.down((0.9, 0.1))
    held.drag((0.3, 0.6))
    axis = tft.rotation_from_matrix(held.matrix() @ tft.rotation_matrix(-0.5, (0, 0, 1)))[1]
    assert np.abs(axis) == pytest.approx((0, 0, 1), abs=1e-6)
    sums = []  # those that upstream's own examples have
    for axes, pressed, moved in (
        ((), (500, 250), (475, 275)),
        (((1, 1, 0), (-1, 1, 0)), (400, 200), (200, 400)),
    ):
        ball = tft.Arcball(initial=(0, 0, 0, 1))
        ball.place((320, 320), 320)
        ball.setaxes(*axes)
        ball.setconstrain(bool(axes))
        ball.down(pressed)
        ball.drag(moved)
        sums.append(ball.matrix().sum())
    assert sums == pytest.approx([3.90583455, 0.2055924])
    assert tft.Arcball([0, 0, 0, 2]).matrix() == pytest.approx(tft.identity_matrix())
    with pytest.raises(ValueError, match='no quaternion and no matrix'):
        tft.Arcball([1, 2, 3])
