# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

from husky_course.route import LIMIT_EXTRA_SEC, plan_route
from husky_course.waypoints import Course, load_course, parse_course, Waypoint
from husky_driver.drive import TimeLimit
import pytest

PERIOD_SEC = 0.02
SHORT = parse_course('waypoints: [[0, 0], [2, 0]]')


def ends_at(limit: TimeLimit, *, nearer_until_sec: float, to_sec: float) -> tuple[float, str]:
    """Return when it complains, and how, if the robot gets on until a time."""
    for period in range(round(to_sec / PERIOD_SEC)):
        time_sec = period * PERIOD_SEC
        if complaint := limit.complaint(time_sec, nearer=time_sec < nearer_until_sec):
            return time_sec, complaint
    return to_sec, ''


def test_a_course_may_take_three_times_what_it_needs(courses: Path) -> None:
    for file in sorted(courses.glob('*.yaml')):
        route = plan_route(load_course(file))
        assert 3.0 <= (route.limit_sec - LIMIT_EXTRA_SEC) / route.par_time_sec < 3.5, file.name


def test_a_long_slow_course_has_the_time_that_it_needs() -> None:
    far = Course('far', (Waypoint(0.0, 0.0), Waypoint(1000.0, 1000.0)), speed_m_s=0.05)
    assert plan_route(far).limit_sec > 3 * 1414 / 0.05


def test_bends_that_must_be_driven_slowly_have_their_time() -> None:
    points = tuple(Waypoint(0.06 * k, 0.006 * (k % 2)) for k in range(500))
    route = plan_route(Course('dense', points, speed_m_s=1.0))
    assert route.limit_sec > 3 * route.par_time_sec + 100.0


def test_who_comes_no_nearer_gives_up_after_half_a_minute() -> None:
    limit = TimeLimit(plan_route(SHORT), 0.0)
    when, why = ends_at(limit, nearer_until_sec=2.0, to_sec=60.0)
    assert when == pytest.approx(32.0, abs=0.1)
    assert why == 'it came no nearer to its goal for 30 s'


def test_who_gets_on_too_slowly_is_out_of_time() -> None:
    limit = TimeLimit(plan_route(SHORT), 0.0)
    when, why = ends_at(limit, nearer_until_sec=1e9, to_sec=100.0)
    assert when == pytest.approx(limit.limit_sec, abs=0.1)
    assert why.startswith('time is up after ')


def test_time_that_it_is_held_does_not_count() -> None:
    limit = TimeLimit(plan_route(SHORT), 0.0)
    assert limit.complaint(5000.0, nearer=False, held=True) == ''
    assert limit.complaint(5001.0, nearer=False) == ''


def test_a_dwell_needs_no_progress_but_has_an_end() -> None:
    course = parse_course('waypoints: [[0, 0], {x: 2, y: 0, dwell: 600}, [4, 0]]')
    limit = TimeLimit(plan_route(course), 0.0)
    assert limit.complaint(600.0, nearer=False, dwelling=True) == ''
    assert 'time is up' in limit.complaint(2500.0, nearer=False, dwelling=True)


def test_a_reset_gives_no_time_back() -> None:
    limit, ended = TimeLimit(plan_route(SHORT), 0.0), ''
    for _ in range(100):  # of 10 s each, begun again and again
        for second in range(11):
            ended = ended or limit.complaint(float(second), nearer=True)
    assert 'time is up' in ended
