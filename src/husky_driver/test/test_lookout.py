# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import math

from husky_driver.lookout import blocked_at_m, FRONT_M, LASER_X_M
from husky_driver.path import smooth_curve
import pytest

BEAMS, FIRST = 721, -math.pi / 2
STEP = math.pi / 720
LINE = smooth_curve([(0.0, 0.0), (10.0, 0.0)])


def scan_of(*points: tuple[float, float]) -> list[float]:
    """Return the ranges of a laser at the origin's robot that sees only these places."""
    ranges = [math.inf] * BEAMS
    for x, y in points:
        beam = round((math.atan2(y, x - LASER_X_M) - FIRST) / STEP)
        ranges[beam] = math.hypot(x - LASER_X_M, y)
    return ranges


def blocked(ranges: list[float], speed_m_s: float = 0.8) -> float | None:
    return blocked_at_m(
        ranges, FIRST, STEP, pose=(0.0, 0.0, 0.0), curve=LINE, s=0.0, speed_m_s=speed_m_s
    )


def test_a_free_path_is_not_blocked() -> None:
    assert blocked([math.inf] * BEAMS) is None
    assert blocked([math.nan] * BEAMS) is None
    assert blocked([0.0] * BEAMS) is None


def test_something_on_the_path_blocks_it_at_its_distance() -> None:
    found = blocked(scan_of((1.2, 0.0)))
    assert found is not None
    assert found == pytest.approx(1.2 - FRONT_M - 0.4, abs=0.06)


def test_what_stands_beside_the_path_does_not_block_it() -> None:
    assert blocked(scan_of((1.0, 0.6), (1.0, -0.6))) is None
    assert blocked(scan_of((1.0, 0.3))) is not None


def test_it_looks_only_as_far_as_it_needs_to_stop() -> None:
    assert blocked(scan_of((1.5, 0.0)), speed_m_s=0.2) is None
    assert blocked(scan_of((1.5, 0.0)), speed_m_s=1.0) is not None


def test_a_wall_beside_a_bend_does_not_block_the_bend() -> None:
    bend = smooth_curve([(0, 0), (1, 0), (1.7, 0.7), (1.7, 2)])
    wall = scan_of(*[(2.3, y / 20) for y in range(-10, 20)])
    assert (
        blocked_at_m(wall, FIRST, STEP, pose=(0, 0, 0), curve=bend, s=0.0, speed_m_s=0.6) is None
    )
