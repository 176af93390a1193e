# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The grader itself, graded: wrong solutions, and the verdict and reason each must get."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
import json
import math
from pathlib import Path
import sys
from typing import Any

from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import Course, load_course, parse_course
from husky_driver.drive import Drive
from husky_driver.motion import Command, Odometry
from husky_grader.grade import main as grade
from husky_grader.run.in_process import drive_with
from husky_grader.scoring.report import judge, Report
import pytest

Turn = Callable[[float, float], tuple[float, float]]

EMPTY = str(Path(__file__).resolve().parents[3] / 'worlds' / 'empty.xml')
BEND = parse_course('speed: 0.8\nwaypoints: [[0, 0], [-2, 1], [-3.5, 0.5], [-4, -1.5]]')


@pytest.fixture
def barrier(courses: Path) -> Course:
    return load_course(courses / 'central_barrier.yaml')


def moved(course: Course, turn: Turn, **changes: Any) -> Course:
    points = []
    for point in course.waypoints:
        x, y = turn(point.x_m, point.y_m)
        points.append(replace(point, x_m=x, y_m=y, **changes))
    return replace(course, waypoints=tuple(points))


def judged(wrong: Course, asked: Course) -> Report:
    """Drive one course where another was asked."""
    return judge(
        read_run(drive_with(Drive(plan_route(wrong)).step, limit_sec=120.0)), plan_route(asked)
    )


def test_the_right_solution_passes(barrier: Course) -> None:
    report = judged(barrier, barrier)
    assert report.passed
    assert report.reasons == ()


def test_one_that_stops_early_is_told_where(barrier: Course) -> None:
    report = judged(replace(barrier, waypoints=barrier.waypoints[:7], loop=False), barrier)
    assert not report.passed
    assert 35 < report.score < 55
    assert report.reasons[0].startswith('missed waypoint 8 at (3.5, 1.25)')
    assert 'stopped at (4.9' in report.reasons[-1]
    assert 'from the last waypoint' in report.reasons[-1]


def test_one_that_cuts_a_corner_is_told_which() -> None:
    asked = parse_course('waypoints: [[0, 0], [-2, 0], [-4, 0], [-4, 2], [-4, 3]]')
    points = (asked.waypoints[0], asked.waypoints[1], asked.waypoints[3], asked.waypoints[4])
    report = judged(replace(asked, waypoints=points), asked)
    assert not report.passed
    assert report.waypoints_reached == 4
    (reason,) = report.reasons
    assert reason.startswith('missed waypoint 3 at (-4, 0): it came no nearer than')


def test_a_drive_all_backwards_gets_half_of_the_points() -> None:
    report = judged(moved(BEND, lambda x, y: (x, y), reverse=True), BEND)
    assert report.waypoints_reached == 4
    assert report.score == pytest.approx(50.0, abs=0.5)
    tracking = report.parts[-1]
    assert tracking.cost_points == pytest.approx(50.0, abs=0.5)
    assert tracking.why.endswith('; 100% of the way in the wrong direction')
    (reason,) = report.reasons
    assert reason.startswith('drove 5.9')
    assert 'm backwards where the course asks for forwards' in reason


def test_a_reversed_forward_axis_is_the_first_reason() -> None:
    drive = Drive(plan_route(BEND))

    def controller(now: Odometry) -> Command | None:
        command = drive.step(now)
        return None if command is None else Command(-command.speed_m_s, command.yaw_rate_rad_s)

    report = judge(read_run(drive_with(controller, world=EMPTY, limit_sec=8.0)), plan_route(BEND))
    assert report.score == 0.0
    assert 'm backwards where the course asks for forwards' in report.reasons[0]


def test_forwards_instead_of_reverse_is_a_reason() -> None:
    asked = parse_course('waypoints: [[0, 0], {x: -4, y: 0, reverse: true}]')
    report = judged(moved(asked, lambda x, y: (x, y), reverse=False), asked)
    assert report.score == pytest.approx(50.0, abs=0.5)
    assert report.reasons == ('drove 3.99 m forwards where the course says reverse: true',)
    assert judged(asked, asked).score == pytest.approx(100.0)


def test_one_that_drives_the_course_from_its_end_is_told_so() -> None:
    first, *others = BEND.waypoints
    report = judged(replace(BEND, waypoints=(first, *others[::-1])), BEND)
    assert not report.passed
    assert report.waypoints_reached == 2
    assert any(reason.endswith('it was there, but not in its turn') for reason in report.reasons)
    assert report.reasons[-1].startswith('it drove the course from its end to its beginning')


def test_one_that_touches_a_cone_is_told_which_and_with_what() -> None:
    asked = parse_course('waypoints: [[0, 0], [-3, -6.5], [-5.59, -8], [-7.5, -8.5]]')
    report = judged(asked, asked)
    assert not report.passed
    assert report.score <= 65.0
    assert any(
        reason.startswith('touched Construction Cone with its') for reason in report.reasons
    )


@pytest.mark.parametrize(
    ('turn', 'reason'),
    [
        (lambda x, y: (x, -y), 'it drove the course mirrored: y is to the left'),
        (lambda x, y: (y, x), 'it drove the course with x and y swapped'),
        (lambda x, y: (-x, -y), 'it drove the course turned by 180 degrees'),
    ],
)
def test_one_in_the_wrong_frame_is_told_which(turn: Turn, reason: str) -> None:
    record = drive_with(Drive(plan_route(moved(BEND, turn))).step, world=EMPTY, limit_sec=60.0)
    report = judge(read_run(record), plan_route(BEND))
    assert not report.passed
    assert any(line.startswith(reason) for line in report.reasons), report.reasons


def test_one_that_takes_degrees_for_radians_is_told_so(barrier: Course) -> None:
    goal = barrier.waypoints[1]

    def controller(now: Odometry) -> Command:
        bearing = math.degrees(math.atan2(goal.y_m - now.y_m, goal.x_m - now.x_m))
        return Command(0.3, bearing - now.yaw_rad)

    report = judge(read_run(drive_with(controller, limit_sec=20.0)), plan_route(barrier))
    assert not report.passed
    assert any('that is rad/s, not degrees' in reason for reason in report.reasons)


def test_one_whose_angles_never_come_back_to_pi_is_told_so() -> None:
    def controller(now: Odometry) -> Command:
        turned = now.time_sec * 2.0  # it takes the angle to its goal for ever larger
        return Command(0.2, min(turned, 2.0))

    report = judge(read_run(drive_with(controller, world=EMPTY, limit_sec=12.0)), plan_route(BEND))
    assert not report.passed
    assert any(
        'rounds more than the path does: angles are in radians' in reason
        for reason in report.reasons
    )


def test_one_that_is_too_fast_loses_points_for_it() -> None:
    asked = parse_course('speed: 0.4\nwaypoints: [[0, 0], [-3, 0], [-6, 0]]')
    report = judged(replace(asked, speed_m_s=1.0), asked)
    assert report.completed
    assert report.score < 60
    assert 'faster than asked' in report.parts[2].why


def test_one_that_never_stops_is_not_completed() -> None:
    asked = parse_course('waypoints: [[0, 0], [-2, 0], [-4, 0]]')
    drive = Drive(plan_route(asked))

    def controller(now: Odometry) -> Command:
        command = drive.step(now)
        return Command(0.5, 0.0) if command is None or now.x_m < -3.5 else command

    report = judge(read_run(drive_with(controller, limit_sec=14.0)), plan_route(asked))
    assert not report.passed
    assert report.waypoints_reached == 3
    assert any(reason.startswith('did not stop: still driving') for reason in report.reasons)


PREAMBLE = """
import rclpy, sys, time
from geometry_msgs.msg import Twist, TwistStamped
rclpy.init()
node = rclpy.create_node('student')
def drive(publisher, message, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        publisher.publish(message)
        time.sleep(0.02)
"""
FORWARD = 'message = Twist(); message.linear.x = 0.5\n'
TOPIC = "'/husky_velocity_controller/cmd_vel'"
LIVE = {
    'wrong topic': (
        f"{FORWARD}drive(node.create_publisher(Twist, '/cmd_vel', 10), message, 9)",
        'it publishes geometry_msgs/msg/Twist on /cmd_vel; the Husky listens on '
        '/husky_velocity_controller/cmd_vel',
    ),
    'wrong type': (
        f'drive(node.create_publisher(TwistStamped, {TOPIC}, 10), TwistStamped(), 9)',
        'it publishes geometry_msgs/msg/TwistStamped on /husky_velocity_controller/cmd_vel; '
        'the Husky takes geometry_msgs/msg/Twist',
    ),
    'best effort': (
        f'{FORWARD}from rclpy.qos import qos_profile_sensor_data as sensor\n'
        f'drive(node.create_publisher(Twist, {TOPIC}, sensor), message, 9)',
        'it publishes /husky_velocity_controller/cmd_vel best effort',
    ),
    'crashes': (
        "raise RuntimeError('no such path')",
        'it crashed (exit code 1): student.py line 11: RuntimeError: no such path',
    ),
    'listens to a name nobody has': (
        'from nav_msgs.msg import Odometry\n'
        f'publisher = node.create_publisher(Twist, {TOPIC}, 10)\n'
        "node.create_subscription(Odometry, 'odometry/filterd', lambda _: None, 10)\n"
        'drive(publisher, Twist(), 2)',
        'it listens to /odometry/filterd, which nobody publishes; did you mean '
        '/odometry/filtered?',
    ),
    'never spins': (
        f'publisher = node.create_publisher(Twist, {TOPIC}, 10)\n'
        'node.create_timer(0.1, lambda: publisher.publish(Twist()))\n'
        'time.sleep(30)',
        'it has a publisher on /husky_velocity_controller/cmd_vel, and never sent a command',
    ),
    'prints only': (
        'from std_srvs.srv import Empty\n'
        "print('driving')\n"
        "node.create_client(Empty, 'no_such_service').wait_for_service(30.0)",
        'it has no publisher on /husky_velocity_controller/cmd_vel: is it made at all, and does '
        'nothing before it wait, such as wait_for_service?',
    ),
    'ends at once': (
        f"node.create_publisher(Twist, {TOPIC}, 10)\nprint('Error: no path')",
        'it ended by itself (exit code 0): Error: no path',
    ),
    'commands once': (
        f'{FORWARD}publisher = node.create_publisher(Twist, {TOPIC}, 10)\n'
        'while not publisher.get_subscription_count():\n    time.sleep(0.01)\n'
        'publisher.publish(message)\n'
        'rclpy.spin(node)',
        'it left the Husky without a command while that drove, which stops after 0.25 s: send '
        'commands again and again, also the same',
    ),
}


@pytest.fixture
def graph(courses: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the processes of a test import what it imports, and find each other quickly."""
    monkeypatch.setenv('PYTHONPATH', ':'.join(sys.path))
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    profile = courses.parent / 'fastdds.xml'
    monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(profile))


@pytest.mark.usefixtures('graph')
@pytest.mark.parametrize('name', LIVE)
def test_a_node_that_does_it_wrong_on_the_graph_is_told_how(name: str, tmp_path: Path) -> None:
    program, reason = LIVE[name]
    course, student = tmp_path / 'course.yaml', tmp_path / 'student.py'
    course.write_text('waypoints: [[0, 0], [1, 0]]\n')
    student.write_text(PREAMBLE + program + '\n')
    code = grade(
        [
            *('--controller', f'{sys.executable} {student}', '--waypoints', str(course)),
            *('--report', str(tmp_path / 'report'), '--real-time-factor', '10'),
        ]
    )
    report = json.loads((tmp_path / 'report' / 'report.json').read_text())
    assert code == 1
    assert report['score'] == 0.0
    assert report['reasons'][0].startswith(reason), report['reasons']


@pytest.mark.usefixtures('graph')
def test_a_node_that_drives_to_the_end_and_stops_passes(tmp_path: Path) -> None:
    course = tmp_path / 'course.yaml'
    course.write_text('speed: 0.5\nwaypoints: [[0, 0], [-0.5, 0.25], [-1, 0]]\n')
    driver = f'{sys.executable} -m husky_driver.follow_path --waypoints {course}'
    arguments = ['--controller', driver, '--waypoints', str(course)]
    arguments += ['--report', str(tmp_path / 'report'), '--real-time-factor', '4']
    assert grade(arguments) == 0


@pytest.mark.usefixtures('graph')
def test_the_sheet_s_questions_can_be_answered_for_a_controller(tmp_path: Path) -> None:
    course = tmp_path / 'course.yaml'
    course.write_text('speed: 0.5\nwaypoints: [[0, 0], [1, 0]]\n')
    driver = f'{sys.executable} -m husky_driver.follow_path'
    arguments = ['--controller', driver, '--waypoints', str(course), '--answers', '0.5,1,1']
    arguments += ['--report', str(tmp_path / 'report'), '--real-time-factor', '4']
    assert grade(arguments) == 0


@pytest.mark.usefixtures('graph')
def test_a_controller_that_cannot_start_is_one_line(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert grade(['--controller', 'no_such_program', '--report', str(tmp_path)]) == 2
    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith("'no_such_program' cannot be started")
