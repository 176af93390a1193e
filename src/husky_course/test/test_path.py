# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import math

from husky_course.route.path import smooth_curve
import pytest

SQUARE = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]


def test_the_curve_passes_every_waypoint_at_its_knot() -> None:
    curve = smooth_curve(SQUARE)
    for point, s in zip(SQUARE, curve.knot_s, strict=True):
        assert curve.point_at(s) == pytest.approx(point, abs=1e-9)


def test_a_closed_curve_ends_where_and_as_it_began() -> None:
    curve = smooth_curve(SQUARE, closed=True)
    assert curve.point_at(curve.length_m) == pytest.approx(SQUARE[0], abs=1e-9)
    assert curve.heading[-1] - curve.heading[0] == pytest.approx(2 * math.pi)
    assert len(curve.knot_s) == 5


def test_two_points_make_a_straight_line_of_their_distance() -> None:
    curve = smooth_curve([(1.0, 1.0), (4.0, 5.0)])
    assert curve.length_m == pytest.approx(5.0, abs=1e-6)
    assert max(map(abs, curve.curvature)) < 1e-9


def test_points_on_a_circle_make_a_curve_of_its_curvature() -> None:
    ring = [(3 * math.cos(a / 8 * math.pi), 3 * math.sin(a / 8 * math.pi)) for a in range(16)]
    curve = smooth_curve(ring, closed=True)
    assert curve.length_m == pytest.approx(6 * math.pi, rel=0.002)
    assert sum(curve.curvature) / len(curve.curvature) == pytest.approx(1 / 3, rel=0.02)


def test_a_projection_has_arc_length_and_offset_to_the_left() -> None:
    curve = smooth_curve([(0.0, 0.0), (10.0, 0.0)])
    _, s, offset = curve.project(0, 3.456, 0.2)
    assert (s, offset) == pytest.approx((3.456, 0.2), abs=1e-6)
    _, s, offset = curve.project(0, 12.0, -0.1)
    assert (s, offset) == pytest.approx((10.0, -0.1), abs=1e-6)


def test_following_a_crossing_stays_on_its_own_branch() -> None:
    eight = [(0.0, 0.0), (2.0, 1.5), (4.0, 0.0), (2.0, -1.5), (0.0, 0.0001), (-2.0, 1.5)]
    curve = smooth_curve(eight)
    i, before = 0, 0.0
    for k in range(len(curve.s)):
        i, s, _ = curve.project(i, curve.x[k], curve.y[k])
        assert s >= before
        assert s == pytest.approx(curve.s[k], abs=1e-6)
        before = s


def test_two_neighbouring_points_at_one_place_are_refused() -> None:
    with pytest.raises(ValueError, match='same place'):
        smooth_curve([(0.0, 0.0), (0.0, 0.0)])
    with pytest.raises(ValueError, match='at least 2'):
        smooth_curve([(0.0, 0.0)])
