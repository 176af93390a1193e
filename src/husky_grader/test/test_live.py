# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Graded runs of controllers of every kind, as real processes over real DDS."""

from __future__ import annotations

import json
import os
from pathlib import Path
import shutil
import sys

from husky_grader.jail import find_sandbox, Jail
from husky_grader.run.answering import Mode
from husky_grader.run.live import drive_live, LiveRun, Progress
from husky_grader.run.told import Told
import numpy as np
from playpen_testing.busy import busy_machine
import pytest

ROOT = Path(__file__).resolve().parents[3]
COURSE = 'speed: 0.5\nwaypoints: [[0, 0], [-1, 0.5], [-2, 0]]\n'
SHORT = 'speed: 0.5\nwaypoints: [[0, 0], [0.5, 0]]\n'
FOLLOWS = """
import sys
from husky_driver.follow_path import main
sys.exit(main(['follow_path', '--waypoints', 'course.yaml']))
"""
NODE = """
import json, sys, rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
rclpy.init()
node = Node('student')
publisher = node.create_publisher(Twist, 'husky_velocity_controller/cmd_vel', 10)
message = Twist()
message.linear.x = 0.5
"""
BY_TIMER = (
    NODE
    + """
def on_timer():
    if node.get_clock().now().nanoseconds > 2e9:
        sys.exit()
    sum(range(1_000_000))  # longer than a control period
    message.linear.x += 0.001
    publisher.publish(message)
node.create_subscription(Odometry, 'odometry/filtered', lambda _: None, 10)
node.create_timer(0.1, on_timer)
rclpy.spin(node)
"""
)
BY_SLEEPING = (
    NODE
    + """
import time
while not publisher.get_subscription_count():
    time.sleep(0.01)  # what is sent before is lost
for _ in range(22):
    publisher.publish(message)
    time.sleep(0.093)  # no whole number of control periods: at any moment of one
def on_diagnostics(told):
    (lost,) = [each.value for each in told.status[0].values if each.key == 'wall_time_lost_sec']
    print('lost', lost, flush=True)
    sys.exit()
from diagnostic_msgs.msg import DiagnosticArray
node.create_subscription(DiagnosticArray, '/diagnostics', on_diagnostics, 10)
rclpy.spin(node)
"""
)
ANSWERS_LATE = (
    NODE
    + """
import time
def on_odometry(_):
    time.sleep(1.0)
    publisher.publish(message)
node.create_subscription(Odometry, 'odometry/filtered', on_odometry, 10)
rclpy.spin(node)
"""
)
LOOKS_ROUND = (
    NODE
    + """
from diagnostic_msgs.msg import DiagnosticArray
def on_diagnostics(told):
    topics = dict(node.get_topic_names_and_types())
    services = [name for name, _ in node.get_service_names_and_types()]
    levels = [ord(status.level) for status in told.status]
    print('seen', json.dumps([list(topics), services, levels]), flush=True)
    sys.exit()
node.create_subscription(Odometry, 'odometry/filtered', lambda _: None, 10)
node.create_subscription(DiagnosticArray, '/diagnostics', on_diagnostics, 10)
rclpy.spin(node)
"""
)
OF_A_ROBOT = {
    *('/clock', '/imu/data', '/joint_states', '/navsat/fix', '/odometry/filtered', '/e_stop'),
    *('/husky_velocity_controller/odom', '/husky_velocity_controller/cmd_vel'),
    *('/husky_velocity_controller/cmd_vel_out', '/diagnostics', '/tf', '/tf_static'),
    *('/robot_description', '/rosout', '/parameter_events'),
}


@pytest.fixture
def course(tmp_path: Path, courses: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Return a course; let the processes of a test find each other, and what they import."""
    monkeypatch.setenv('PYTHONPATH', ':'.join(sys.path))
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(courses.parent / 'fastdds.xml'))
    file = tmp_path / 'course.yaml'
    file.write_text(COURSE)
    return str(file)


def drive_in_jail(
    program: str,
    course: str,
    folder: Path,
    on_progress: Progress = lambda _: None,
    *,
    sandbox: str = 'auto',
) -> LiveRun:
    """Drive in a sandbox; when left out, in that which a teaching assistant gets here."""
    theirs = folder / 'theirs'
    theirs.mkdir(parents=True)
    (theirs / 'student.py').write_text(program)
    shutil.copy(course, theirs / 'course.yaml')
    command = f'{sys.executable} {theirs}/student.py'
    # The lab's own driver, which is not there for students, as one that answers.
    known = [path for path in map(Path, sys.path) if path.is_relative_to(ROOT)]
    ours = [path for path in known if path.is_dir()] + [ROOT / 'src']
    environment = {'PYTHONPATH': os.environ['PYTHONPATH']}
    with Jail(find_sandbox(sandbox), theirs, readable=ours) as jail:
        return drive_live(
            command, course, folder, jail, environment=environment, on_progress=on_progress
        )


def test_one_that_answers_drives_the_same_on_a_busy_machine(course: str, tmp_path: Path) -> None:
    told: list[Told] = []
    quiet = drive_in_jail(FOLLOWS, course, tmp_path / 'a', told.append)
    with busy_machine(4):
        busy = drive_in_jail(FOLLOWS, course, tmp_path / 'b')
    assert quiet.pace == busy.pace == 'in lockstep: each odometry message waited for its command'
    assert quiet.record.rows.tobytes() == busy.record.rows.tobytes()
    assert quiet.ending == busy.ending
    assert told[-1].waypoints_left == 0, 'its progress should be told'


@pytest.mark.parametrize('sandbox', ['auto', 'none'])
def test_it_finds_the_robot_whatever_network_its_terminal_is_for(
    course: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sandbox: str
) -> None:
    Path(course).write_text(SHORT)
    # Either of them alone would keep them apart.
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
    monkeypatch.setenv('ROS_DISCOVERY_SERVER', '127.0.0.1:11811')
    run = drive_in_jail(FOLLOWS, course, tmp_path, sandbox=sandbox)
    assert run.pace == Mode.ANSWERS.value, run.notes  # a driver that finds no robot ends, too
    assert run.ending == 'the controller has ended'


def test_one_on_simulated_time_is_waited_for(course: str, tmp_path: Path) -> None:
    run = drive_in_jail(BY_TIMER, course, tmp_path / 'run')
    assert run.pace == Mode.CLOCKED.value.format(factor=1)
    time_sec, speed = run.record.column(0, 'time_sec'), run.record.column(0, 'command_speed_m_s')
    acted_sec = time_sec[:-1][np.diff(speed) != 0.0]
    assert acted_sec == pytest.approx(np.arange(1, 21) / 10), 'each command acts when it is due'


def test_one_with_another_clock_drives_at_the_pace_of_the_clock(
    course: str, tmp_path: Path
) -> None:
    run = drive_in_jail(BY_SLEEPING, course, tmp_path / 'run')
    assert run.pace == Mode.OTHER_CLOCK.value.format(factor=1)
    x = run.record.column(0, 'x')
    # What a busy machine holds the simulator up for is left out, and told; on a free one nothing.
    log = (tmp_path / 'run' / 'controller.log').read_text()
    lost_m = 0.5 * float(log.partition('lost ')[2].split()[0])
    went_m = abs(x[-1] - x[0])
    assert 0.8 - lost_m < went_m < 1.3, 'it should be half a metre a second for two seconds'


def test_a_graded_controller_finds_what_a_robot_offers(course: str, tmp_path: Path) -> None:
    drive_in_jail(LOOKS_ROUND, course, tmp_path / 'run')
    log = (tmp_path / 'run' / 'controller.log').read_text()
    assert 'seen ' in log, log
    topics, services, levels = json.loads(log.partition('seen ')[2].splitlines()[0])
    assert levels == [0], 'a time that waits for it is told as a machine that is too slow'
    assert set(topics) <= OF_A_ROBOT
    assert [name for name in services if not name.startswith('/student/')] == []


def test_one_that_answers_late_has_an_end(
    course: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr('husky_grader.run.live.WALL_SEC', 5.0)
    run = drive_in_jail(ANSWERS_LATE, course, tmp_path / 'run')
    assert run.ending == 'it took 5 s on the clock'
    assert 0.0 < run.record.duration_sec < 1.0


def test_one_that_chooses_its_own_domain_is_told(
    course: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr('husky_grader.run.live.WALL_SEC', 5.0)
    away = NODE.replace('rclpy.init()', 'rclpy.init(domain_id=77)') + 'rclpy.spin(node)\n'
    run = drive_in_jail(away, course, tmp_path / 'run', sandbox='kernel')
    (note,) = run.notes
    assert note.startswith('it is in domain 77, where nobody hears it'), run.notes
