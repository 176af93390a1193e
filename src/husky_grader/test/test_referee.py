# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""When the run of somebody's controller is over."""

from __future__ import annotations

from collections.abc import Callable
import math
from pathlib import Path
from typing import Any

from husky_course.route import plan_route
from husky_course.waypoints import Course, load_course, parse_course
from husky_driver.drive import Drive
from husky_driver.motion import Odometry
from husky_grader.run.referee import Referee
import pytest

PERIOD_SEC = 0.02
LOOP = parse_course('speed: 0.5\nloop: true\nwaypoints: [[0, 0], [40, 0], [40, 40], [0, 40]]')


def ending(referee: Referee, track: list[Odometry]) -> tuple[str, float]:
    """Return how and when a run of these poses ends."""
    for now in track:
        over = referee.over(
            now.time_sec,
            (now.x_m, now.y_m),
            speed_m_s=now.speed_m_s,
            yaw_rate_rad_s=now.yaw_rate_rad_s,
            running=True,
        )
        if over:
            return over, now.time_sec
    return '', track[-1].time_sec


def standing(from_sec: float, x: float, y: float, duration_sec: float) -> list[Odometry]:
    periods = range(1, round(duration_sec / PERIOD_SEC))
    return [Odometry(from_sec + k * PERIOD_SEC, x, y, 0.0, 0.0, 0.0) for k in periods]


def circles(radius_m: float, duration_sec: float) -> list[Odometry]:
    speed = 0.5
    track = []
    for period in range(round(duration_sec / PERIOD_SEC)):
        turn = period * PERIOD_SEC * speed / radius_m
        x, y = radius_m * math.sin(turn), radius_m * (1 - math.cos(turn))
        track.append(Odometry(period * PERIOD_SEC, x, y, turn, speed, speed / radius_m))
    return track


@pytest.mark.parametrize('name', ['central_barrier', 'figure_eight', 'square', 'slalom'])
def test_a_right_drive_ends_at_the_end_of_the_course(
    courses: Path, drive_to_end: Callable[..., Any], name: str
) -> None:
    course = load_course(courses / f'{name}.yaml')
    track = drive_to_end(Drive(plan_route(course), slip=False)).track
    end = track[-1]
    after = standing(end.time_sec, end.x_m, end.y_m, 5.0)
    assert (
        ending(Referee(plan_route(course)), track + after)[0]
        == 'it stands at the end of the course'
    )


@pytest.mark.parametrize(
    'course',
    [
        LOOP,
        parse_course(
            'speed: 0.5\nwaypoints: [[0, 0], [30, 0], [0, 0], [30, 0], [0, 0], [30, 0], [0, 0]]'
        ),
    ],
    ids=['loop', 'to and fro'],
)
def test_a_long_way_back_to_where_it_was_is_progress(
    drive_to_end: Callable[..., Any], course: Course
) -> None:
    track = drive_to_end(Drive(plan_route(course), slip=False), limit_sec=1000.0).track
    end = track[-1]
    after = standing(end.time_sec, end.x_m, end.y_m, 5.0)
    over, when = ending(Referee(plan_route(course)), track + after)
    assert over == 'it stands at the end of the course'
    assert when >= end.time_sec


def test_laps_near_the_start_are_progress() -> None:
    corners = ''.join(f', [{x}, {y}]' for x, y in [(0.4, 0.4), (0, 0.8), (-0.4, 0.4), (0, 0)] * 12)
    course = parse_course(f'speed: 0.5\nwaypoints: [[0, 0]{corners}]')
    track = circles(0.4, 12 * 2 * math.pi * 0.4 / 0.5)
    after = standing(track[-1].time_sec, 0.0, 0.0, 5.0)
    over, when = ending(Referee(plan_route(course)), track + after)
    assert over == 'it stands at the end of the course'
    assert when >= track[-1].time_sec


def test_one_that_drives_round_and_round_is_ended() -> None:
    course = parse_course('waypoints: [[0, 0], [200, 0]]')
    over, when = ending(Referee(plan_route(course)), circles(0.5, 100.0))
    assert over == 'it came no nearer to its goal for 30 s'
    assert when < 40.0


def test_one_that_dwells_where_it_is_asked_to_may_go_on() -> None:
    course = parse_course('waypoints: [[0, 0], {x: 2, y: 0, dwell: 600}, [4, 0]]')
    way = [Odometry(k * PERIOD_SEC, 0.01 * k, 0.0, 0.0, 0.5, 0.0) for k in range(201)]
    assert ending(Referee(plan_route(course)), way + standing(4.0, 2.0, 0.0, 605.0))[0] == ''
    over, when = ending(Referee(plan_route(course)), way + standing(4.0, 2.0, 0.0, 700.0))
    assert over == 'it stood still for 608 s'
    assert when == pytest.approx(612.0, abs=0.1)
    elsewhere = [now._replace(y_m=1.0) for now in way] + standing(4.0, 2.0, 1.0, 20.0)
    assert ending(Referee(plan_route(course)), elsewhere)[0] == 'it stood still for 8 s'


def test_a_waypoint_near_the_start_is_not_waited_for_at_the_end() -> None:
    course = parse_course('waypoints: [[0, 0], [0.5, 0], [4, 0]]')
    way = [Odometry(k * PERIOD_SEC, 0.01 * k, 0.0, 0.0, 0.5, 0.0) for k in range(401)]
    over, when = ending(Referee(plan_route(course)), way + standing(8.0, 4.0, 0.0, 5.0))
    assert over == 'it stands at the end of the course'
    assert when == pytest.approx(10.0, abs=0.1)


def test_one_that_rests_where_the_course_will_end_may_go_on() -> None:
    course = parse_course('waypoints: [[0, 0], [4, 0], [0, 0], [4, 0], [0, 0]]')
    places = [*(0.01 * k for k in range(411)), *(0.01 * k for k in range(410, -1, -1))]
    way = [Odometry(k * PERIOD_SEC, x, 0.0, 0.0, 0.5, 0.0) for k, x in enumerate(places)]
    begun_sec = len(way) * PERIOD_SEC
    rest = standing(begun_sec, 0.0, 0.0, 5.0)
    assert ending(Referee(plan_route(course)), way + rest)[0] == ''
    again = [now._replace(time_sec=now.time_sec + begun_sec + 5.0) for now in way]
    after = standing(2 * begun_sec + 5.0, 0.0, 0.0, 5.0)
    over, _ = ending(Referee(plan_route(course)), [*way, *rest, *again, *after])
    assert over == 'it stands at the end of the course'


def test_one_that_resets_the_simulator_for_ever_is_ended() -> None:
    course = parse_course('waypoints: [[0, 0], [4, 0]]')
    way = [Odometry(k * PERIOD_SEC, 0.01 * k, 0.0, 0.0, 0.5, 0.0) for k in range(201)]
    over, _ = ending(Referee(plan_route(course)), way * 100)
    assert over.startswith(('time is up after', 'it came no nearer'))
