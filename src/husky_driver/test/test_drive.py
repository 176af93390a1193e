# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from collections.abc import Callable
from itertools import pairwise
import math
from pathlib import Path
from typing import Any

from husky_driver.drive import DistanceDrive, Drive
from husky_driver.motion import Odometry
from husky_driver.slip import NO_SLIP
from husky_driver.waypoints import Course, load_course, parse_course
import pytest


def drive_of(course: Course) -> Drive:
    """Return a drive for the plant of these tests, which does not slide."""
    return Drive(course, slip=NO_SLIP)


HUSKIES = [
    {},
    {'lag_sec': 0.02, 'yaw_gain': 1.0},
    {'lag_sec': 0.1, 'yaw_gain': 0.9, 'delay_periods': 3},
]


@pytest.mark.parametrize('husky', HUSKIES)
def test_the_course_is_followed_within_two_centimetres_at_88_percent_of_the_speed(
    courses: Path, drive_to_end: Callable[..., Any], make_plant: Any, husky: dict[str, float]
) -> None:
    course = load_course(courses / 'central_barrier.yaml')
    run = drive_to_end(drive_of(course), make_plant(**husky))
    curve, i, worst = run.drive.legs[0].curve, 0, 0.0
    for odometry in run.track:
        i, _, offset = curve.project(i, odometry.x_m, odometry.y_m)
        worst = max(worst, abs(offset))
    assert worst < 0.02
    assert run.drive.failure == ''
    assert run.drive.reached == run.drive.total == 13
    assert curve.length_m / run.track[-1].time_sec > 0.88 * course.speed_m_s


def test_it_ends_standing_on_the_last_waypoint(
    courses: Path, drive_to_end: Callable[..., Any]
) -> None:
    run = drive_to_end(drive_of(load_course(courses / 'straight.yaml')))
    last, end = run.drive.course.stops[-1], run.track[-1]
    assert math.hypot(end.x_m - last.x_m, end.y_m - last.y_m) < 0.01
    assert end.is_standing
    assert run.commands[-1] == (0.0, 0.0)


def test_commands_keep_the_limits_of_the_velocity_controller(
    courses: Path, drive_to_end: Callable[..., Any]
) -> None:
    commands = drive_to_end(drive_of(load_course(courses / 'central_barrier.yaml'))).commands
    for before, after in pairwise(commands):
        assert abs(after.speed_m_s) <= 1.0
        assert abs(after.yaw_rate_rad_s) <= 2.0
        assert abs(after.speed_m_s - before.speed_m_s) <= 3.0 * 0.02 + 1e-9
        assert abs(after.yaw_rate_rad_s - before.yaw_rate_rad_s) <= 6.0 * 0.02 + 1e-9


def test_the_same_odometry_gives_the_same_commands_to_the_last_bit(
    courses: Path, drive_to_end: Callable[..., Any]
) -> None:
    course = load_course(courses / 'central_barrier.yaml')
    first, second = (drive_to_end(drive_of(course)).commands for _ in range(2))
    assert first == second


def test_a_far_start_is_led_in_to_the_first_waypoint(
    drive_to_end: Callable[..., Any],
) -> None:
    course = parse_course('waypoints: [[2.0, 1.0], [4.0, 1.0]]')
    run = drive_to_end(drive_of(course))
    assert run.drive.reached == 2
    assert min(math.hypot(o.x_m - 2.0, o.y_m - 1.0) for o in run.track) < 0.02


def test_speeds_yaw_dwell_and_reverse_of_waypoints_are_obeyed(
    drive_to_end: Callable[..., Any],
) -> None:
    course = parse_course(
        'speed: 0.8\nwaypoints:\n  - [0, 0]\n  - {x: 3, y: 0, speed: 0.3}\n'
        '  - {x: 6, y: 0, yaw: 1.57, dwell: 2.0}\n  - {x: 6, y: -2, reverse: true}\n'
    )
    run = drive_to_end(drive_of(course))
    slow = [o.speed_m_s for o in run.track if 1.0 < o.x_m < 2.8]
    assert max(slow) < 0.32
    fast = [o.speed_m_s for o in run.track if 4.0 < o.x_m < 5.0]
    assert max(fast) > 0.78
    standing = [
        o for o in run.track if o.is_standing and abs(o.x_m - 6) < 0.02 and abs(o.y_m) < 0.02
    ]
    turned = [o for o in standing if abs(o.yaw_rad - 1.57) < 0.03]
    assert turned[-1].time_sec - turned[0].time_sec >= 1.99
    assert min(o.speed_m_s for o in run.track) < -0.7
    assert run.track[-1].yaw_rad == pytest.approx(math.pi / 2, abs=0.05)
    assert run.drive.reached == 4


def test_sharp_corners_are_turned_on_the_spot(drive_to_end: Callable[..., Any]) -> None:
    course = parse_course('corners: sharp\nwaypoints: [[0, 0], [2, 0], [2, 2]]')
    run = drive_to_end(drive_of(course))
    for odometry in run.track:
        assert min(abs(odometry.y_m), abs(odometry.x_m - 2.0)) < 0.02


@pytest.mark.parametrize('forward', [True, False])
def test_an_asked_distance_is_driven_from_wherever_the_robot_stands(
    drive_to_end: Callable[..., Any], make_plant: Any, forward: bool
) -> None:
    start = Odometry(3.0, 1.0, 2.0, 0.7, 0.0, 0.0)
    run = drive_to_end(DistanceDrive(0.6, 2.5, forward=forward), make_plant(now=start))
    end = run.track[-1]
    sign = 1.0 if forward else -1.0
    assert end.x_m - start.x_m == pytest.approx(sign * 2.5 * math.cos(0.7), abs=0.01)
    assert end.y_m - start.y_m == pytest.approx(sign * 2.5 * math.sin(0.7), abs=0.01)
    assert max(abs(o.speed_m_s) for o in run.track) == pytest.approx(0.6, abs=0.02)


def test_a_robot_that_does_not_move_is_given_up_with_a_message() -> None:
    drive = drive_of(parse_course('waypoints: [[0, 0], [2, 0]]'))
    periods = 0
    while drive.step(Odometry(periods * 0.02, 0.0, 0.0, 0.0, 0.0, 0.0)) is not None:
        periods += 1
        assert periods < 1000
    assert 'the robot does not move: told to drive 0.50 m/s' in drive.failure


def test_a_waypoint_passed_too_far_away_counts_as_missed(
    drive_to_end: Callable[..., Any], make_plant: Any
) -> None:
    drive = drive_of(parse_course('tolerance: 0.05\nwaypoints: [[0, 0], [2, 0], [4, 0]]'))
    plant = make_plant()
    while plant.now.x_m < 1.9:
        command = drive.step(plant.now)
        assert command is not None
        plant.advance(command)
    plant.now = plant.now._replace(y_m=0.2)  # somebody pushes the robot aside
    run = drive_to_end(drive, plant)
    assert (run.drive.reached, run.drive.total) == (2, 3)


def test_a_reset_of_the_simulator_begins_the_course_again(
    drive_to_end: Callable[..., Any], make_plant: Any
) -> None:
    drive = drive_of(parse_course('waypoints: [[0, 0], [2, 0]]'))
    plant = make_plant()
    for _ in range(100):
        command = drive.step(plant.now)
        assert command is not None
        plant.advance(command)
    assert drive.remaining_m < 1.5
    run = drive_to_end(drive)
    assert run.drive.reached == 2
    assert run.track[-1].x_m == pytest.approx(2.0, abs=0.01)


def test_a_held_drive_stands_and_then_goes_on(
    drive_to_end: Callable[..., Any], make_plant: Any
) -> None:
    drive = drive_of(parse_course('speed: 0.8\nwaypoints: [[0, 0], [3, 0]]'))
    plant = make_plant()
    for period in range(400):
        drive.held = period >= 75
        command = drive.step(plant.now)
        assert command is not None
        plant.advance(command)
    assert plant.now.is_standing
    assert 0.8 < plant.now.x_m < 2.0
    drive.held = False
    run = drive_to_end(drive, plant)
    assert run.drive.failure == ''
    assert run.drive.reached == 2
    assert run.track[-1].x_m == pytest.approx(3.0, abs=0.01)


def test_a_drive_that_begins_in_motion_stops_first(
    drive_to_end: Callable[..., Any], make_plant: Any
) -> None:
    plant = make_plant(now=Odometry(5.0, 0.0, 0.0, 0.0, 0.8, 0.3))
    run = drive_to_end(drive_of(parse_course('waypoints: [[-1, 0], [-2, 0]]')), plant)
    assert run.drive.reached == 2
    assert run.commands[0] == (0.0, 0.0)
