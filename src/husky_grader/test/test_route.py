# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where a course is cut into legs, and that every one so cut is driven to its end."""

from __future__ import annotations

import math
from pathlib import Path
import random

from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import Course, load_course, parse_course, Waypoint
from husky_driver.drive import Drive
from husky_driver.motion import Command, Odometry
from husky_grader.run.in_process import drive_with
from husky_grader.scoring.report import judge
import pytest

EMPTY = str(Path(__file__).resolve().parents[3] / 'worlds' / 'empty.xml')
COURSES = 24
TURNS_DEG = ((30.0, 180.0), (80.0, 180.0), (170.0, 180.0), (180.0, 180.0))


def zigzag(seed: int) -> Course:
    """Return a course whose every corner turns back, or nearly, or as sharp as any."""
    dice = random.Random(seed)
    x, y, heading = 0.0, 0.0, dice.uniform(-3.0, 3.0)
    points = [Waypoint(x, y)]
    for _ in range(dice.randint(2, 7)):
        length = dice.choice([0.05, 0.1, 0.2, 0.5, 1.0, 2.0]) * dice.uniform(1.0, 1.3)
        x, y = x + length * math.cos(heading), y + length * math.sin(heading)
        points.append(Waypoint(x, y))
        turn = math.radians(dice.uniform(*dice.choice(TURNS_DEG)))
        heading += dice.choice([-1.0, 1.0]) * turn
    return Course('zigzag', tuple(points), speed_m_s=dice.choice([0.1, 0.3, 0.5, 1.0]))


def driven(course: Course) -> tuple[Drive, float, float]:
    """
    Drive with the simulator's physics; return the drive and how far it came off the path.

    The first distance is what the driver believed, the second the truth.
    """
    route = plan_route(course)
    drive, worst_m = Drive(route), 0.0

    def controller(odometry: Odometry) -> Command | None:
        nonlocal worst_m
        command = drive.step(odometry)
        if drive.tracker is not None:
            worst_m = max(worst_m, abs(drive.tracker.offset_m))
        return command

    record = drive_with(controller, on_imu=drive.add_imu, world=EMPTY)
    return drive, worst_m, judge(read_run(record), route).cross_track_max_m


def assert_driven_to_its_end(course: Course) -> None:
    drive, believed_m, true_m = driven(course)
    goal, end = course.stops[-1], drive.odometry
    assert end is not None
    assert (drive.failure, drive.reached) == ('', drive.total)
    assert math.hypot(end.x_m - goal.x_m, end.y_m - goal.y_m) < 0.04
    assert max(believed_m, true_m) < 0.05


@pytest.mark.parametrize('seed', range(COURSES))
def test_a_course_that_turns_back_is_driven_to_its_end(seed: int) -> None:
    assert_driven_to_its_end(zigzag(seed))


@pytest.mark.parametrize(
    'points',
    [
        'waypoints: [[0, 0], [0, 2], [0, 0]]',
        'waypoints: [[0, 0], [2, 0], [1.9, 0]]',
        'waypoints: [[0, 0], [2, 0], [1.9, 0.002], [3, 0]]',
        'waypoints: [[0, 0], [0.1, 0], [-2, 0]]',
        'loop: true\nwaypoints: [[0, 0], [-2, 0.1], [-2, -0.1]]',
        'loop: true\nwaypoints: [[0, 0], [2, 0], [4, 0]]',
    ],
)
def test_a_way_there_and_back_is_driven_to_its_end(points: str) -> None:
    assert_driven_to_its_end(parse_course(points))


@pytest.mark.parametrize(
    ('degrees', 'arm_m', 'legs'), [(115, 1.0, 1), (125, 1.0, 2), (90, 0.3, 1), (90, 0.25, 2)]
)
def test_a_corner_too_tight_for_a_curve_is_a_cut(degrees: float, arm_m: float, legs: int) -> None:
    turn = math.radians(degrees)
    far = Waypoint(2.0 + arm_m * math.cos(turn), arm_m * math.sin(turn))
    course = Course('corner', (Waypoint(0.0, 0.0), Waypoint(2.0, 0.0), far))
    assert len(plan_route(course).legs) == legs


def test_the_lab_s_smooth_courses_are_one_curve_each(courses: Path) -> None:
    for file in sorted(courses.glob('*.yaml')):
        course = load_course(file)
        if course.corners == 'smooth':
            assert len(plan_route(course).legs) == 1, file.name
