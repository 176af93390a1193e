# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import math
from pathlib import Path

from husky_course.robot import ROBOT_LENGTH_M, ROBOT_WIDTH_M
from husky_course.route import plan_route
from husky_course.waypoints import parse_course
from husky_driver.checks import Bump
from husky_driver.checks.path_scan import FRONT_M, HALF_WIDTH_M, LASER_X_M
from husky_driver.motion import read_imu
from husky_grader.run.in_process import Conditions, drive_route
from husky_sim.world import default_worlds, FIXED_FRAMES
import pytest

EMPTY = str(default_worlds() / 'empty.xml')
NORTH_WALL = (-2.0, 8.5, math.pi / 2)  # a metre before it, and square to it


def test_the_driver_knows_the_robot_of_the_simulator() -> None:
    assert FIXED_FRAMES['front_laser'].position_m[0] == LASER_X_M
    assert pytest.approx(ROBOT_LENGTH_M / 2, abs=0.001) == FRONT_M
    assert pytest.approx(ROBOT_WIDTH_M / 2 + 0.06, abs=0.001) == HALF_WIDTH_M


def held_sec(
    wheels: list[float],
    body: list[float],
    *,
    gap: int = -1,
    unheard: range = range(0),
    yaw_rate_rad_s: float = 0.0,
) -> float | None:
    """
    Return when it was noticed, of speeds 20 ms apart.

    :param gap: where the IMU misses 0.2 s; unheard: which odometries are lost.
    """
    bump = Bump()
    for i in range(1, len(wheels)):
        if not gap <= i < gap + 10:
            bump.add_acceleration(i * 0.02, (body[i] - body[i - 1]) / 0.02)
        if i not in unheard and bump.is_held(i * 0.02, wheels[i], yaw_rate_rad_s):
            return i * 0.02
    return None


def speeds(before: float, after: float) -> list[float]:
    return [0.0] * 50 + [before] * 100 + [after] * 100


@pytest.mark.parametrize('speed_m_s', [1.0, 0.15, -0.5])
def test_a_held_robot_is_noticed_within_a_second(
    speed_m_s: float,
) -> None:
    noticed = held_sec(speeds(speed_m_s, speed_m_s), speeds(speed_m_s, 0.0))
    assert noticed is not None
    assert 3.0 < noticed < 4.0


def test_a_robot_that_does_as_its_wheels_is_left_alone() -> None:
    assert held_sec(speeds(1.0, 0.0), speeds(1.0, 0.0)) is None
    assert held_sec(speeds(0.8, 0.8), speeds(0.8, 0.5)) is None  # slowed, not stopped


@pytest.mark.parametrize(
    ('speed_m_s', 'enough_m_s', 'too_little_m_s', 'yaw_rate_rad_s'),
    [
        (1.0, 0.61, 0.59, 0.0),  # six tenths of its speed
        (-1.0, -0.61, -0.59, 0.0),
        (0.12, 0.083, 0.077, 0.0),  # noise and bends
        (0.4, 0.29, 0.27, -1.0),  # and the point about which it turns
    ],
)
def test_a_robot_is_held_once_it_has_lost_enough(
    speed_m_s: float, enough_m_s: float, too_little_m_s: float, yaw_rate_rad_s: float
) -> None:
    wheels = speeds(speed_m_s, speed_m_s)
    for lost_m_s, noticed in ((enough_m_s, True), (too_little_m_s, False)):
        body = speeds(speed_m_s, speed_m_s - lost_m_s)
        found = held_sec(wheels, body, yaw_rate_rad_s=yaw_rate_rad_s)
        assert (found is not None) is noticed, lost_m_s


def test_a_held_robot_is_given_half_a_second() -> None:
    # It is stopped after 3 s, and what the IMU tells is used when it is 0.1 s old.
    noticed_sec = held_sec(speeds(0.5, 0.5), speeds(0.5, 0.0))
    assert noticed_sec == pytest.approx(3.6, abs=0.03)


def test_of_a_robot_slower_than_10_cm_a_second_nothing_is_told() -> None:
    assert held_sec(speeds(0.105, 0.105), speeds(0.105, 0.0)) is not None
    assert held_sec(speeds(0.095, 0.095), speeds(0.095, 0.0)) is None


def test_a_robot_that_turns_about_a_point_beside_its_middle_is_left_alone() -> None:
    # The wheels go backwards so that it stays on the spot, which the driver does not know yet.
    wheels, body = speeds(0.0, -0.25), speeds(0.0, 0.0)
    assert held_sec(wheels, body) is not None
    assert held_sec(wheels, body, yaw_rate_rad_s=1.4) is None
    assert held_sec(speeds(0.8, 0.8), speeds(0.8, 0.0), yaw_rate_rad_s=1.0) is not None


@pytest.mark.parametrize(
    ('floor', 'speed_m_s', 'goal'),
    [('asphalt', 0.1, (-1.5, 0.5)), ('ideal', 0.2, (-1.0, 1.0)), ('wet', 0.2, (0.0, -1.5))],
)
def test_a_robot_that_has_just_turned_is_left_alone(
    floor: str, speed_m_s: float, goal: tuple[float, float]
) -> None:
    # What the IMU has felt in the turn is in the window until two seconds after it.
    course = parse_course(f'speed: {speed_m_s}\nwaypoints: [[0, 0], {list(goal)}]')
    conditions = Conditions(floor=floor, realistic=True)
    _, drive = drive_route(plan_route(course), world=EMPTY, conditions=conditions)
    assert drive.failure == ''
    assert drive.reached == drive.total


@pytest.mark.parametrize(('speed_m_s', 'y_m'), [(0.2, 9.1), (0.8, 8.9)])
def test_a_wall_soon_after_a_turn_is_noticed(speed_m_s: float, y_m: float) -> None:
    course = parse_course(f'speed: {speed_m_s}\ncorners: sharp\nwaypoints: [[0, 0], [0, 6]]')
    record, drive = drive_route(plan_route(course), start=(-2.0, y_m, 0.0))
    assert 'the IMU has felt the robot stop' in drive.failure
    assert drive.elapsed_sec - record.collisions[0].time_sec < 3.0, 'it went on pushing'


def test_a_robot_that_gets_its_speed_back_at_once_is_left_alone() -> None:
    wheels, body = speeds(0.8, 0.8), speeds(0.8, 0.8)
    body[150:165] = [0.1] * 15
    assert held_sec(wheels, body) is None


def test_what_no_sample_tells_of_is_not_guessed() -> None:
    assert held_sec(speeds(0.8, 0.8), speeds(0.8, 0.8), gap=48) is None
    assert held_sec([1.0] * 200, [1.0] * 200) is None  # it began while the robot was driving


@pytest.mark.parametrize('lost', [range(148, 190), range(148, 165), range(140, 151)])
def test_a_robot_that_brakes_while_no_odometry_comes_is_left_alone(lost: range) -> None:
    assert held_sec(speeds(0.8, 0.0), speeds(0.8, 0.0), unheard=lost) is None


def test_a_robot_that_is_held_after_a_gap_in_odometry_is_noticed() -> None:
    assert held_sec(speeds(0.8, 0.8), speeds(0.8, 0.0), unheard=range(80, 120)) is not None


def test_gravity_that_an_inclined_imu_feels_does_not_count() -> None:
    pitch = -0.3  # nose up, after REP-103
    felt = 9.81 * math.sin(-pitch)
    q = (0.0, math.sin(pitch / 2), 0.0, math.cos(pitch / 2))
    assert read_imu(0.0, (felt, 0.0), *q)[2:] == pytest.approx((0.0, 0.0), abs=1e-9)
    assert read_imu(0.0, (felt + 0.5, 0.2), *q)[2:] == pytest.approx((0.5, 0.2))
    roll = 0.2  # the left side up
    felt = 9.81 * math.sin(roll)
    q = (math.sin(roll / 2), 0.0, 0.0, math.cos(roll / 2))
    assert read_imu(0.0, (0.5, felt + 0.2), *q)[2:] == pytest.approx((0.5, 0.2))


@pytest.mark.parametrize('gravity', ['0.2 0 -9.8', '2 -1 -9.5'])
def test_a_robot_on_a_slope_is_left_alone(tmp_path: Path, gravity: str) -> None:
    world = tmp_path / 'slope.xml'
    text = Path(EMPTY).read_text(encoding='utf-8')
    world.write_text(text.replace('gravity="0 0 -9.8"', f'gravity="{gravity}"'), encoding='utf-8')
    course = parse_course('waypoints: [[0, 0], [2, 0], [3, 1]]')
    record, drive = drive_route(plan_route(course), world=str(world))
    assert (drive.failure, drive.reached) == ('', drive.total)
    assert math.hypot(*(record.rows[-1, 0, 1:3] - (3.0, 1.0))) < 0.1


@pytest.mark.parametrize(('speed_m_s', 'reverse'), [(0.2, False), (0.8, True)])
def test_a_drive_straight_against_a_wall_is_given_up(speed_m_s: float, reverse: bool) -> None:
    course = parse_course(
        f'speed: {speed_m_s}\nwaypoints: [[0, 0], {{x: {-6 if reverse else 6}, y: 0, '
        f'reverse: {str(reverse).lower()}}}]'
    )
    x, y, yaw = NORTH_WALL
    record, drive = drive_route(plan_route(course), start=(x, y, -yaw if reverse else yaw))
    assert drive.failure.startswith('the wheels drive ')
    assert 'm/s, but the IMU has felt the robot stop: something holds it near' in drive.failure
    touched_sec = record.collisions[0].time_sec
    assert drive.elapsed_sec - touched_sec < 1.5, 'it went on pushing'
