# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is measured where a course asks for several speeds and directions."""

from collections.abc import Callable
from itertools import pairwise
import math

from husky_course.record import read_run, Record
from husky_course.route import plan_route
from husky_course.waypoints import parse_course
from husky_grader.scoring.report import judge
import pytest

Make = Callable[..., Record]
Places = list[tuple[float, float]]


def driven(*stretches: tuple[float, float, float]) -> Places:
    """Return places on the x axis: of each stretch from where, to where, and how fast."""
    places: Places = []
    for begin, end, speed_m_s in stretches:
        count = round(abs(end - begin) / speed_m_s / 0.02)
        places += [(begin + (end - begin) * k / count, 0.0) for k in range(count)]
    return places + [(stretches[-1][1], 0.0)] * 10


def test_each_leg_has_a_speed_of_its_own(make_record: Make) -> None:
    text = 'speed: 0.5\nwaypoints: [[0, 0], {x: 2, y: 0, dwell: 0.1}, {x: 4, y: 0, speed: 0.25}]'
    route = plan_route(parse_course(text))
    obeyed, swapped = (
        judge(read_run(make_record(driven((0, 2, first), (2, 4, second)))), route)
        for first, second in ((0.5, 0.25), (0.25, 0.5))
    )
    assert obeyed.score == pytest.approx(100.0)
    assert obeyed.too_fast == 0.0
    assert swapped.too_fast == pytest.approx(4 / 12, abs=0.01), '2 m at 0.5 m/s, 2 m at 0.25 m/s'
    assert swapped.parts[2].why.endswith('; 33% of the time faster than asked')
    assert swapped.parts[2].factor == pytest.approx(1 - 0.5 * swapped.too_fast)


@pytest.mark.parametrize(('speed_m_s', 'share'), [(0.56, 0.0), (0.58, 1.0)])
def test_a_tenth_and_2_cm_a_second_are_not_too_fast(
    make_record: Make, speed_m_s: float, share: float
) -> None:
    route = plan_route(parse_course('speed: 0.5\nwaypoints: [[0, 0], [4, 0]]'))
    report = judge(read_run(make_record(driven((0, 4, speed_m_s)))), route)
    assert report.too_fast == pytest.approx(share, abs=0.01)


def test_where_the_direction_changes_either_is_right(make_record: Make) -> None:
    back = '{x: 0, y: 0, reverse: true}'
    text = f'speed: 0.5\nwaypoints: [[0, 0], [2, 0], {back}, [2, 0], {back}]'
    turns = [0.0, 2.15, -0.15, 2.15, 0.0]  # a little farther than asked, each time
    places = driven(*((begin, end, 0.5) for begin, end in pairwise(turns)))
    speed = [math.copysign(0.5, b[0] - a[0]) for a, b in pairwise(places[:-9])] + [0.0] * 10
    report = judge(read_run(make_record(places, speed_m_s=speed)), plan_route(parse_course(text)))
    assert (report.backwards_m, report.forwards_m, report.wrong_way) == (0.0, 0.0, 0.0)
    assert report.waypoints_reached == 5


def test_accelerations_are_the_rms_of_the_drive(make_record: Make) -> None:
    count = 200
    record = make_record(
        [(0.25 * (k * 0.02) ** 2, 0.0) for k in range(count)],
        speed_m_s=[0.5 * k * 0.02 for k in range(count)],
        yaw_rate_rad_s=[-0.25 * k * 0.02 for k in range(count)],
    )
    report = judge(read_run(record), plan_route(parse_course('waypoints: [[0, 0], [4, 0]]')))
    assert report.acceleration_rms_m_s2 == pytest.approx(0.5)
    assert report.yaw_acceleration_rms_rad_s2 == pytest.approx(0.25)
