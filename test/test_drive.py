# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator and the driver together, over DDS: whole courses, and what goes wrong."""

import math
from pathlib import Path
import signal
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from husky_course.record import read_record, read_run, Record
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_driver.drive import Drive
from husky_driver.ros.node import FollowPath
from husky_grader.scoring.report import judge, Report
from husky_sim.ros.node import SimulatorNode
from nav_msgs.msg import Odometry
from playpen_testing.forks import Ended, run_forked
from playpen_testing.listener import Listener
from playpen_testing.processes import Processes
from playpen_testing.spinning import SpunNodes
from playpen_testing.standard_error import standard_error
from playpen_testing.waiting import wait_until
import pytest
from rcl_interfaces.msg import Log
from std_srvs.srv import Empty

ROOT = Path(__file__).resolve().parent.parent
COURSES = ROOT / 'config' / 'waypoints'
THROUGH_THE_BARRIER = """\
frame: odom
speed: 0.6
waypoints:
  - [0.0, 0.0]
  - [4.5, 0.0]
"""

CRATE = """\
  <body name="crate" mocap="true" pos="-2.5 0.1 0.3"><geom type="box" size="0.2 0.3 0.3"/></body>
</worldbody>"""


def drive(
    nodes: SpunNodes, course: Path, record: Path, *, timeout_sec: float, **time: Any
) -> tuple[int, Record]:
    """Drive a course with real nodes; return the driver's exit code and the run's record."""
    simulator = nodes.start(SimulatorNode, record=str(record), **time)
    driver = nodes.start(
        FollowPath,
        lambda *_: Drive(plan_route(load_course(course))),
        progress='off',
    )
    wait_until(driver.finished.done, timeout_sec=timeout_sec, what=f'the end of {course.name}')
    nodes.close(driver)
    nodes.close(simulator)
    exit_code = driver.finished.result()
    assert exit_code is not None
    return exit_code, read_record(record)


def well_driven(report: Report) -> bool:
    # A wheel may slip, and in real time a command may come a period late.
    near = report.cross_track_rms_m <= 0.10 and report.cross_track_max_m <= 0.30
    return report.completed and report.collisions == () and near


def test_the_central_barrier_is_driven_round_without_a_touch(
    nodes: SpunNodes, tmp_path: Path
) -> None:
    course, record = COURSES / 'central_barrier.yaml', tmp_path / 'run.record'
    in_lockstep = {'lockstep': True, 'real_time_factor': 0.0}
    exit_code, run = drive(nodes, course, record, timeout_sec=90, **in_lockstep)
    report = judge(read_run(run), plan_route(load_course(str(course))))
    assert exit_code == 0
    assert well_driven(report), report
    assert report.waypoints_reached == report.waypoints_total == 13
    average_m_s = report.driven_m / report.sim_time_sec
    assert average_m_s >= 0.75 * load_course(str(course)).speed_m_s


def test_a_bend_is_driven_in_real_time(nodes: SpunNodes, tmp_path: Path) -> None:
    course, record = tmp_path / 'bend.yaml', tmp_path / 'run.record'
    course.write_text('speed: 1.0\nwaypoints: [[0, 0], [-2, 1], [-3.5, 0.5], [-4, -1.5]]\n')
    in_real_time = {'lockstep': False, 'real_time_factor': 1.0}
    exit_code, run = drive(nodes, course, record, timeout_sec=60, **in_real_time)
    report = judge(read_run(run), plan_route(load_course(str(course))))
    assert exit_code == 0
    assert well_driven(report), report
    assert report.waypoints_reached == report.waypoints_total == 4


def test_a_course_through_the_barrier_reports_the_collision(
    nodes: SpunNodes, tmp_path: Path
) -> None:
    course = tmp_path / 'through.yaml'
    course.write_text(THROUGH_THE_BARRIER)
    listener = nodes.start(Listener, {'collisions': DiagnosticStatus})
    exit_code, record = drive(
        nodes,
        course,
        tmp_path / 'run.record',
        timeout_sec=60,
        lockstep=True,
        real_time_factor=0.0,
    )
    assert exit_code == 1, 'the driver must give up in front of the barrier'
    touch = listener.latest('collisions')
    assert touch.name == 'jersey_barrier_15'
    values = {entry.key: entry.value for entry in touch.values}
    assert values['obstacle'] == 'jersey_barrier_15'
    assert float(values['force_n']) > 0.0
    report = judge(read_run(record), plan_route(load_course(str(course))))
    assert not report.completed
    assert {collision.obstacle for collision in report.collisions} == {'jersey_barrier_15'}


def test_one_that_turns_over_on_the_barrier_is_told_so(nodes: SpunNodes, tmp_path: Path) -> None:
    start, record = 'husky 2.22 1.7 -1.2217', tmp_path / 'run.record'  # aslant towards it
    simulator = nodes.start(
        SimulatorNode, robots=[start], record=str(record), real_time_factor=2.0
    )
    listener = nodes.start(Listener, {'odometry/filtered': Odometry})

    def turns_over() -> bool:
        listener.command(1.0)
        return 'turned over' in logged()

    with standard_error() as logged:
        wait_until(turns_over, timeout_sec=30.0, what='a line that it has turned over')
        listener.command(0.0)
        nodes.close(simulator)
        (line,) = [line for line in logged().splitlines() if 'turned over' in line]
    assert 'husky: turned over at (' in line
    assert line.endswith(
        ', as when it climbs an obstacle; its wheels carry it no more: reset the simulation'
    )
    assert [over.robot for over in read_record(record).overturns] == ['husky']


def test_the_laser_stops_it_until_an_unmapped_box_is_gone(
    nodes: SpunNodes, tmp_path: Path
) -> None:
    world, course, record = (tmp_path / name for name in ('w.xml', 'c.yaml', 'run.record'))
    playpen = (ROOT / 'worlds' / 'playpen.xml').read_text()
    world.write_text(playpen.replace('</worldbody>', CRATE))
    course.write_text('speed: 0.8\nwaypoints: [[0, 0], [2, 0], [4, 0]]\n')
    listener = nodes.start(Listener, {'/rosout': Log, 'odometry/filtered': Odometry})
    simulator = nodes.start(
        SimulatorNode,
        world=str(world), yaw=math.pi, record=str(record),
        lidar_rate_hz=20.0, lockstep=True, real_time_factor=0.0,
    )  # fmt: skip
    driver = nodes.start(
        FollowPath,
        lambda *_: Drive(plan_route(load_course(course))),
        scan=True, progress='off',
    )  # fmt: skip

    def lines() -> list[str]:
        return [log.msg for log in listener.heard['/rosout'] if log.name == 'follow_path']

    wait_until(lambda: len(lines()) > 0, timeout_sec=20.0, what='a line about the crate')
    wait_until(
        lambda: abs(listener.latest('odometry/filtered').twist.twist.linear.x) < 0.005,
        timeout_sec=10.0,
        what='a robot that stands',
    )
    (said,) = lines()
    assert said.startswith('stopping: something 0.6 m wide stands on the path, ')
    x_m, y_m = map(float, said[said.rindex('(') + 1 : -1].split(','))
    assert (x_m, y_m) == pytest.approx((2.3, 0.0), abs=0.1)
    x = listener.latest('odometry/filtered').pose.pose.position.x
    assert 1.0 < x < 2.3 - 0.49 - 0.25, 'it stands in front, not against it'
    assert not driver.finished.done()
    simulator.simulation.data.mocap_pos[0, 1] = 5.0
    wait_until(driver.finished.done, timeout_sec=20.0, what='the end of the course')
    wait_until(lambda: len(lines()) > 2, timeout_sec=5.0, what='a line about the end')
    assert lines()[1] == 'the way is free: driving on'
    assert lines()[2].startswith('done: 3 of 3 waypoints')
    nodes.close(simulator)
    assert read_record(record).collisions == ()


@pytest.mark.timeout(60)
@pytest.mark.parametrize('is_reset', [False, True])
def test_ground_truth_is_followed_from_the_start_wherever_it_is(
    nodes: SpunNodes, tmp_path: Path, is_reset: bool
) -> None:
    world, course = str(ROOT / 'worlds' / 'empty.xml'), tmp_path / 'ahead.yaml'
    course.write_text('speed: 0.8\nwaypoints: [[2, 0], [3, 0]]\n')
    # Slowly: while the driver, in the same process, stands still for a moment, the robot goes on.
    nodes.start(SimulatorNode, world=world, x=3.0, y=-1.0, yaw=math.pi / 2, real_time_factor=0.5)
    listener = nodes.start(Listener, {'ground_truth/odom': Odometry})

    def place() -> tuple[float, float]:
        position = listener.latest('ground_truth/odom').pose.pose.position
        return position.x, position.y

    def is_ahead() -> bool:
        listener.command(1.0)
        return place()[1] > 0.0

    wait_until(is_ahead, timeout_sec=10.0, what='a robot 1 m ahead of its start')
    driver = nodes.start(
        FollowPath,
        lambda *_: Drive(plan_route(load_course(course)), slip=False),
        odometry='ground_truth', start=[3.0, -1.0, math.pi / 2], progress='off',
    )  # fmt: skip
    if is_reset:
        wait_until(lambda: place()[1] > 0.8, timeout_sec=20.0, what='a robot on its way')
        listener.create_client(Empty, 'husky_sim/reset').call_async(Empty.Request())
        wait_until(lambda: place()[1] < -0.9, timeout_sec=10.0, what='a robot at its start')
    wait_until(driver.finished.done, timeout_sec=30.0, what='the end of the course')
    assert driver.finished.result() == 0
    assert place() == pytest.approx((3.0, 2.0), abs=0.1)


@pytest.mark.timeout(60)
def test_a_killed_simulator_ends_the_driver_with_a_message(processes: Processes) -> None:
    simulator = processes.start('ros2', 'run', 'husky_sim', 'husky_sim')
    course = str(COURSES / 'straight.yaml')
    driver = processes.start(
        'ros2', 'run', 'husky_driver', 'follow_path', '--waypoints', course,
        '--ros-args', '-p', 'startup_timeout_sec:=20.0',
    )  # fmt: skip
    driver.wait_for_text('%')
    simulator.signal(signal.SIGKILL)
    assert driver.wait(timeout_sec=12.0) == 1
    assert 'no odometry for 5 s' in driver.output
    assert 'Traceback' not in driver.output


BAD_FILES = {
    'speed: fast\nwaypoints: [[0, 0], [1, 0]]\n': ['line 1', 'speed'],
    'waypoints:\n  - [0, 0]\n  - [1, north]\n': ['line 3', 'waypoints'],
    'waypoints: [\n': ['line'],
}


@pytest.fixture(scope='module')
def refused(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Ended]:
    files = [tmp_path_factory.mktemp('refused') / 'bad.yaml' for _ in BAD_FILES]
    for file, text in zip(files, BAD_FILES, strict=True):
        file.write_text(text)
    ended = run_forked(*(('husky_driver.follow_path', '--waypoints', str(each)) for each in files))
    return dict(zip(BAD_FILES, ended, strict=True))


@pytest.mark.parametrize('text', BAD_FILES)
def test_a_bad_waypoint_file_is_refused_with_its_line(
    refused: dict[str, Ended], text: str
) -> None:
    ended = refused[text]
    assert ended.status == 2
    output = ended.out + ended.err
    assert [word for word in ['bad.yaml', *BAD_FILES[text]] if word not in output] == []
    assert 'Traceback' not in output


def test_the_robot_stands_where_the_facts_put_it(nodes: SpunNodes) -> None:
    nodes.start(SimulatorNode, x=-4.0, y=1.0, yaw=math.pi / 2)
    listener = nodes.start(Listener, {'ground_truth/odom': Odometry})
    pose = listener.latest('ground_truth/odom').pose.pose
    assert (pose.position.x, pose.position.y) == pytest.approx((-4.0, 1.0), abs=1e-3)
    assert 2 * math.atan2(pose.orientation.z, pose.orientation.w) == pytest.approx(
        math.pi / 2, abs=1e-3
    )
