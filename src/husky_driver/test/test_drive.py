# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from collections.abc import Callable
from itertools import pairwise
import math
from pathlib import Path
import random
from typing import Any

from husky_course.route import A200_LIMITS, plan_route
from husky_course.waypoints import Course, load_course, parse_course
from husky_driver.drive.drive import DistanceDrive, Drive
from husky_driver.drive.route_follower import REST_SEC
from husky_driver.motion import Command, ImuReading, Odometry
import pytest


def drive_of(course: Course) -> Drive:
    """Return a drive for the plant of these tests, which does not slide."""
    return Drive(plan_route(course), slip=False)


HUSKIES = [
    {},
    {'lag_sec': 0.02, 'yaw_gain': 1.0},
    {'lag_sec': 0.1, 'yaw_gain': 0.9, 'delay_periods': 3},
]


@pytest.mark.parametrize('husky', HUSKIES)
def test_a_course_is_followed_within_2_cm_at_88_percent_speed(
    courses: Path, drive_to_end: Callable[..., Any], make_plant: Any, husky: dict[str, float]
) -> None:
    course = load_course(courses / 'central_barrier.yaml')
    run = drive_to_end(drive_of(course), make_plant(**husky))
    curve, i, worst = run.drive.route.legs[0].curve, 0, 0.0
    for odometry in run.track:
        i, _, offset = curve.project(i, odometry.x_m, odometry.y_m)
        worst = max(worst, abs(offset))
    assert worst < 0.02
    assert run.drive.failure == ''
    assert run.drive.reached == run.drive.total == 13
    assert curve.length_m / (run.track[-1].time_sec - REST_SEC) > 0.88 * course.speed_m_s


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


def test_commands_keep_the_lower_limits_of_a_real_robot(
    courses: Path, drive_to_end: Callable[..., Any]
) -> None:
    route = plan_route(load_course(courses / 'central_barrier.yaml'))
    run = drive_to_end(Drive(route, slip=False, limits=A200_LIMITS))
    assert (run.drive.failure, run.drive.reached) == ('', 13)
    for before, after in pairwise(run.commands):
        assert abs(after.speed_m_s) <= 1.0
        assert abs(after.yaw_rate_rad_s) <= 1.0
        assert abs(after.speed_m_s - before.speed_m_s) <= 1.0 * 0.02 + 1e-9
        assert abs(after.yaw_rate_rad_s - before.yaw_rate_rad_s) <= 1.0 * 0.02 + 1e-9


def test_the_same_odometry_gives_bit_identical_commands(
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


def test_a_wide_tolerance_does_not_leave_the_way_to_the_path_out(
    drive_to_end: Callable[..., Any],
) -> None:
    course = parse_course('tolerance: 1.0\nwaypoints: [[0.0, 0.9], [1.5, 0.9]]')
    run = drive_to_end(drive_of(course))
    assert run.drive.reached == 2
    assert min(math.hypot(o.x_m, o.y_m - 0.9) for o in run.track) < 0.02
    assert max(abs(o.y_m - 0.9) for o in run.track if o.x_m > 0.1) < 0.02


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


def test_the_way_to_a_first_waypoint_with_reverse_is_driven_backwards(
    drive_to_end: Callable[..., Any],
) -> None:
    course = parse_course('waypoints: [{x: -2, y: 0, reverse: true}, [0, 0], [2, 0]]')
    run = drive_to_end(drive_of(course))
    assert run.drive.reached == 3
    assert min(o.speed_m_s for o in run.track) < -0.4
    assert max(abs(o.yaw_rad) for o in run.track) < 0.05  # it does not turn round


@pytest.mark.parametrize('end_y_m', [2, -2])
def test_sharp_corners_are_turned_on_the_spot(make_plant: Any, end_y_m: int) -> None:
    course = parse_course(f'corners: sharp\nwaypoints: [[0, 0], [2, 0], [2, {end_y_m}]]')
    drive, plant = drive_of(course), make_plant()
    left_m, turning_m = list[float](), list[float]()
    while (command := drive.step(plant.now)) is not None:
        left_m.append(drive.remaining_m)
        assert min(abs(plant.now.y_m), abs(plant.now.x_m - 2.0)) < 0.02
        if 0.1 < abs(plant.now.yaw_rad) < 1.4:
            assert abs(command.speed_m_s) < 0.1, f'it drives while it turns: {plant.now}'
            turning_m.append(drive.remaining_m)
        plant.advance(command)
    assert turning_m, 'it has not turned'
    assert (left_m[5], turning_m[0]) == pytest.approx((4.0, 2.0), abs=0.05), 'both legs count'
    assert drive.reached == 3
    assert drive.remaining_m == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize('forward', [True, False])
def test_a_distance_is_driven_from_any_start_pose(
    drive_to_end: Callable[..., Any], make_plant: Any, forward: bool
) -> None:
    start = Odometry(3.0, 1.0, 2.0, 0.7, 0.0, 0.0)
    moves = DistanceDrive(0.6, 2.5, forward=forward, limits=A200_LIMITS)
    run = drive_to_end(moves, make_plant(now=start))
    end = run.track[-1]
    sign = 1.0 if forward else -1.0
    assert end.x_m - start.x_m == pytest.approx(sign * 2.5 * math.cos(0.7), abs=0.01)
    assert end.y_m - start.y_m == pytest.approx(sign * 2.5 * math.sin(0.7), abs=0.01)
    assert max(abs(o.speed_m_s) for o in run.track) == pytest.approx(0.6, abs=0.02)
    assert run.drive.elapsed_sec == end.time_sec - start.time_sec
    assert max(abs(o.yaw_rad - 0.7) for o in run.track) < 0.02, 'it does not turn round'
    for before, after in pairwise(run.commands):
        assert abs(after.speed_m_s - before.speed_m_s) <= 1.0 * 0.02 + 1e-9


@pytest.mark.parametrize(
    ('to', 'after_sec', 'why'),
    [
        (
            '[2, 0]',
            4.5,
            'the robot does not move: told to drive 0.50 m/s and turn 0.00 rad/s, but for 4 s its '
            'odometry has stayed at (0.10, 0.00); does an emergency stop (e_stop) hold it?',
        ),
        (
            '[-2, 0]',
            1.5,
            'the wheels slip: told to turn 2.00 rad/s, but it turns 0.00 rad/s; is something '
            'in its way near (0.10, 0.00), its battery empty, or its emergency stop (e_stop) '
            'pressed?',
        ),
        (
            '{x: -2, y: 0, reverse: true}',
            4.5,
            'the robot does not move: told to drive -0.50 m/s and turn 0.00 rad/s, but for 4 s '
            'its odometry has stayed at (0.10, 0.00); does an emergency stop (e_stop) hold it?',
        ),
        (
            '[-2, -0.5]',
            1.5,
            'the wheels slip: told to turn -2.00 rad/s, but it turns 0.00 rad/s; is something '
            'in its way near (0.10, 0.00), its battery empty, or its emergency stop (e_stop) '
            'pressed?',
        ),
    ],
)
def test_a_robot_that_does_not_move_is_given_up_with_a_message(
    to: str, after_sec: float, why: str
) -> None:
    drive = drive_of(parse_course(f'waypoints: [[0, 0], {to}]'))
    periods, stands = 0, Odometry(0.0, 0.1, 0.0, 0.0, 0.0, 0.0)
    while not drive.failure:
        drive.step(stands._replace(time_sec=periods * 0.02))
        periods += 1
        assert periods < 1000
    assert drive.failure == why
    assert periods * 0.02 == pytest.approx(after_sec, abs=0.1)


def test_the_time_in_which_no_odometry_comes_is_no_standing_still() -> None:
    drive = drive_of(parse_course('waypoints: [[0, 0], [2, 0]]'))
    for begin in (0, 150, 300):  # three times two seconds
        for period in range(begin, begin + 100):
            drive.step(Odometry(period * 0.02, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert drive.failure == ''


def test_one_that_gave_up_is_stopped_until_it_stays_at_rest() -> None:
    drive = drive_of(parse_course('waypoints: [[0, 0], [2, 0]]'))
    speeds = [0.3, 0.2, 0.1, 0.0, -0.1, -0.2, -0.1] + 50 * [0.0]  # falls off what it climbed
    drive.step(Odometry(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    drive.give_up('enough')
    x_m, ended = 0.0, 0
    for period, speed in enumerate(speeds, start=1):
        x_m += 0.02 * speed
        if drive.step(Odometry(period * 0.02, x_m, 0.0, 0.0, speed, 0.0)) is None:
            ended = period
            break
    assert ended > 8 + 0.4 / 0.02, 'it ended between rolling forth and back'
    assert ended < 8 + 0.6 / 0.02


@pytest.mark.parametrize('gives_up', [True, False])
def test_a_robot_that_rolls_on_is_not_stopped_for_ever(gives_up: bool) -> None:
    drive = drive_of(parse_course('waypoints: [[0, 0], [2, 0]]'))
    moves, period = [False], 0
    while not any(moves):
        command = drive.step(Odometry(period * 0.02, 0.004 * period, 0.0, 0.0, 0.2, 0.0))
        if gives_up:
            drive.give_up('enough')
        moves.append(command is None or command.speed_m_s > 0.0)
        period += 1
        assert period < 250, f'told to stand for 5 s: {drive.failure}'
    assert drive.finished is gives_up
    assert period * 0.02 > 3.0


def test_one_that_gave_up_ends_soon_also_where_the_simulation_is_reset() -> None:
    drive = drive_of(parse_course('waypoints: [[0, 0], [2, 0]]'))
    drive.step(Odometry(100.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    drive.give_up('enough')
    times = [100.02, *(0.02 * k for k in range(50))]
    commands = [drive.step(Odometry(time, 0.0, 0.0, 0.0, 0.0, 0.0)) for time in times]
    assert commands[1] is not None
    assert commands[-1] is None


def test_a_waypoint_passed_too_far_away_counts_as_missed(
    drive_to_end: Callable[..., Any], make_plant: Any
) -> None:
    course = 'tolerance: 0.05\nwaypoints: [[-1, 0], {x: 0, y: 0, dwell: 0.1}, [2, 0], [4, 0]]'
    drive = drive_of(parse_course(course))
    plant = make_plant(now=Odometry(0.0, -1.0, 0.0, 0.0, 0.0, 0.0))
    while plant.now.x_m < 1.9:
        command = drive.step(plant.now)
        assert command is not None
        plant.advance(command)
    plant.now = plant.now._replace(y_m=0.2)  # somebody pushes the robot aside
    run = drive_to_end(drive, plant)
    assert (run.drive.reached, run.drive.total) == (3, 4)


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
        drive.held = period >= 100
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


LED_IN = """\
speed: 0.8
waypoints:
  - [1, 1]
  - {x: 2, y: 1, dwell: 0.5}
  - {x: 2, y: 2, yaw: 0}
  - {x: 1, y: 2, reverse: true}
"""


@pytest.mark.parametrize('course', [LED_IN, 'waypoints: [[0, 0], [1, 0], [0, 0]]'])
def test_after_a_reset_at_any_moment_the_course_is_driven_again(
    drive_to_end: Callable[..., Any], make_plant: Any, course: str
) -> None:
    whole = len(drive_to_end(drive_of(parse_course(course))).commands)
    for moment in range(1, whole, 23):
        drive, plant = drive_of(parse_course(course)), make_plant()
        for _ in range(moment):
            command = drive.step(plant.now)
            assert command is not None
            plant.advance(command)
        again = drive_to_end(drive)
        assert (drive.failure, drive.reached) == ('', drive.total), f'after {moment} periods'
        assert len(again.commands) == pytest.approx(whole, abs=5)


@pytest.mark.parametrize(
    ('changes', 'said'),
    [
        ({'x_m': math.nan}, 'its x is nan m'),
        ({'y_m': 4.4e87}, 'its y is 4.4e+87 m'),
        ({'yaw_rad': math.inf}, 'its yaw is inf rad'),
        ({'speed_m_s': math.nan}, 'its speed is nan m/s'),
        ({'x_m': 3.0}, 'it jumps 1.89 m'),
        ({'time_sec': 1.5}, 'which is no reset'),
    ],
)
def test_implausible_odometry_ends_the_drive_at_once(
    make_plant: Any, changes: dict[str, float], said: str
) -> None:
    drive, plant = drive_of(parse_course('speed: 0.8\nwaypoints: [[0, 0], [9, 0]]')), make_plant()
    for _ in range(105):
        plant.advance(drive.step(plant.now))
    plausible = drive.odometry
    commands = []
    while (command := drive.step(plant.now._replace(**changes))) is not None:
        commands.append(command)
        plant.advance(command)
        drive.add_imu(ImuReading(plant.now.time_sec, 0.0, math.nan, 0.0))
        assert len(commands) < 100
    assert said in drive.failure == drive.implausible
    assert set(commands) == {(0.0, 0.0)}
    assert plant.now.is_standing
    assert drive.odometry is plausible
    assert math.isfinite(drive.remaining_m)


@pytest.mark.parametrize('seed', range(20))
def test_mixed_odometry_of_two_robots_ends_a_drive(make_plant: Any, seed: int) -> None:
    dice = random.Random(seed)
    drive, other = drive_of(parse_course(LED_IN)), drive_of(parse_course(LED_IN))
    ours, theirs = make_plant(), make_plant()
    for _ in range(dice.randint(0, 300)):
        theirs.advance(other.step(theirs.now) or Command(0.0, 0.0))
    for _ in range(3000):
        if dice.random() < 0.5:
            theirs.advance(other.step(theirs.now) or Command(0.0, 0.0))
            command = drive.step(theirs.now)
        else:
            command = drive.step(ours.now)
            ours.advance(command or Command(0.0, 0.0))
        if command is None:
            break
    assert drive.finished


def test_a_robot_that_moves_but_gets_no_nearer_is_given_up(make_plant: Any) -> None:
    drive, plant = drive_of(parse_course('waypoints: [[0, 0], [9, 0]]')), make_plant()
    while (command := drive.step(plant.now)) is not None:
        plant.advance(command)
        if plant.now.x_m > 2.0:  # a slope on which it slides back, again and again
            plant.now = plant.now._replace(x_m=1.9)
        assert plant.now.time_sec < 60.0
    assert drive.failure.startswith('it came no nearer to its goal for 30 s; it is at (')
    assert drive.failure.endswith(' m of path are left')


def test_a_slow_drive_that_comes_nearer_is_not_given_up(
    drive_to_end: Callable[..., Any],
) -> None:
    run = drive_to_end(drive_of(parse_course('speed: 0.1\nwaypoints: [[0, 0], [4, 0]]')))
    assert (run.drive.failure, run.drive.reached) == ('', 2)
    assert run.drive.elapsed_sec > 40.0


def test_a_drive_that_is_held_for_an_hour_goes_on(
    drive_to_end: Callable[..., Any], make_plant: Any
) -> None:
    drive, plant = drive_of(parse_course('waypoints: [[0, 0], [2, 0]]')), make_plant()
    for _ in range(60):
        plant.advance(drive.step(plant.now))
    drive.held = True
    for _ in range(60):
        plant.advance(drive.step(plant.now))
    for time_sec in range(20, 3601, 20):  # odometry goes on, if not as often
        plant.now = plant.now._replace(time_sec=float(time_sec))
        drive.step(plant.now)
    drive.held = False
    assert drive_to_end(drive, plant, limit_sec=3700.0).drive.failure == ''


def test_a_long_dwell_is_not_given_up(drive_to_end: Callable[..., Any]) -> None:
    course = parse_course('waypoints: [[0, 0], {x: 1, y: 0, dwell: 100}, [2, 0]]')
    drive = drive_to_end(drive_of(course)).drive
    assert (drive.failure, drive.reached) == ('', 3)
    assert 103.0 < drive.elapsed_sec < 115.0


def test_the_summary_leaves_the_time_to_the_report(drive_to_end: Callable[..., Any]) -> None:
    drive = drive_to_end(drive_of(parse_course('waypoints: [[0, 0], [2, 0]]'))).drive
    assert drive.summary() == '2 of 2 waypoints, 2.00 m of path'
