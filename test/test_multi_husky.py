# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Three Huskies in one playpen, as launched: each in its namespace, at its place, on its own."""

from functools import partial
import math
from pathlib import Path
import signal

from ament_index_python.packages import get_package_prefix
from nav_msgs.msg import Odometry
from playpen_testing.listener import Listener
from playpen_testing.processes import Process, Processes
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from sensor_msgs.msg import LaserScan

PARAMETERS = """
/**:
  ros__parameters:
    real_time_factor: 3.0
    lidar_rate_hz: 0.0
"""
# Of multi_husky_playpen.launch of the original, its 30 and 45 read as degrees.
STARTS = {
    'husky_alpha': (0.0, 0.0, 0.0),
    'husky_beta': (1.0, 3.0, math.radians(30.0)),
    'husky_gamma': (-3.0, -1.0, math.radians(45.0)),
}


def pose(message: Odometry) -> tuple[float, float, float]:
    position, turn = message.pose.pose.position, message.pose.pose.orientation
    return position.x, position.y, 2.0 * math.atan2(turn.z, turn.w)


@pytest.mark.timeout(60)
def test_one_of_three_huskies_is_driven_alone(
    processes: Processes, nodes: SpunNodes, tmp_path: Path
) -> None:
    parameters = tmp_path / 'parameters.yaml'
    parameters.write_text(PARAMETERS)
    launch = processes.start(
        *('ros2', 'launch', 'husky_sim', 'multi_husky_playpen.launch.py'),
        *(f'params_file:={parameters}', 'lidar_rate_hz:=5.0', 'x:=1.5'),
    )
    launch.wait_for_text('obstacles')
    launch.wait_for_text('; 3 x real time')  # of the file, for it is not given beside it
    assert 'x=1.5 changes nothing, because robots say where they start' in launch.output
    topics = {f'/{name}/ground_truth/odom': Odometry for name in STARTS}
    topics['/husky_beta/front/scan'] = LaserScan  # given, which counts more than the file
    listener = nodes.start(partial(Listener, topics, namespace='husky_beta'))
    for name, start in STARTS.items():
        first = listener.latest(f'/{name}/ground_truth/odom')
        assert pose(first) == pytest.approx(start, abs=0.001), name
        assert first.child_frame_id == 'base_link'

    listener.latest('/husky_beta/front/scan')

    def pushed() -> bool:
        listener.command(0.5)
        return pose(listener.latest('/husky_beta/ground_truth/odom'))[0] > 1.2

    wait_until(pushed, timeout_sec=15.0, what='20 cm of husky_beta')
    for name in ('husky_alpha', 'husky_gamma'):
        last = listener.latest(f'/{name}/ground_truth/odom')
        assert pose(last) == pytest.approx(STARTS[name], abs=0.001), name
    launch.signal(signal.SIGINT)
    assert launch.wait(timeout_sec=10.0) == 0
    assert 'Traceback' not in launch.output


@pytest.mark.timeout(90)
def test_in_lockstep_a_robot_drives_on_when_another_is_done(
    processes: Processes, tmp_path: Path
) -> None:
    simulator = processes.start(
        *('ros2', 'run', 'husky_sim', 'husky_sim', '--ros-args', '-p', 'lockstep:=true'),
        *('-p', "robots:=['near 0 0 0', 'far -3 -1 0']", '-p', 'real_time_factor:=0.0'),
    )

    def start_driver(name: str, goal_m: float) -> Process:
        course = tmp_path / f'{name}_{goal_m}.yaml'
        course.write_text(f'waypoints: [[0, 0], [{goal_m}, 0]]')
        return processes.start(
            *('ros2', 'run', 'husky_driver', 'follow_path', '--waypoints', str(course)),
            *('--ros-args', '-r', f'__ns:=/{name}', '-p', 'check:=off'),
            *('-p', 'startup_timeout_sec:=30.0'),
        )

    near = start_driver('near', 0.3)
    simulator.wait_for_text('so far nobody drives far', timeout_sec=30.0)
    far = start_driver('far', 2.0)
    for driver in (near, far):
        assert driver.wait(timeout_sec=30.0) == 0, driver.output + simulator.output
    # One that comes when time waits for commands has missed the odometry that it is to answer.
    again = start_driver('far', 1.0)
    assert again.wait(timeout_sec=30.0) == 0, again.output + simulator.output


@pytest.mark.timeout(90)
def test_in_lockstep_a_driver_that_is_stopped_is_named(
    processes: Processes, tmp_path: Path
) -> None:
    simulator = processes.start(
        *('ros2', 'run', 'husky_sim', 'husky_sim', '--ros-args', '-p', 'lockstep:=true'),
        *('-p', "robots:=['near 0 0 0', 'far -3 -1 0']"),
    )
    course = tmp_path / 'course.yaml'
    course.write_text('waypoints: [[0, 0], [1.0, 0]]')
    program = Path(get_package_prefix('husky_driver')) / 'lib' / 'husky_driver' / 'follow_path'
    drivers = {
        name: processes.start(
            *(str(program), '--waypoints', str(course), '--ros-args', '-r', f'__ns:=/{name}'),
            *('-p', 'check:=off', '-p', 'startup_timeout_sec:=30.0'),
            # It is told 3 s to 4 s after the stop; what was lost DDS sends again within 3 s more.
            *('-p', 'odometry_timeout_sec:=20.0'),
        )
        for name in ('near', 'far')
    }
    drivers['far'].wait_for_text(' m left', timeout_sec=30.0)
    drivers['far'].signal(signal.SIGSTOP)
    try:
        simulator.wait_for_text('no driver answers of far', timeout_sec=20.0)
    finally:
        drivers['far'].signal(signal.SIGCONT)
    for driver in drivers.values():
        assert driver.wait(timeout_sec=30.0) == 0, driver.output + simulator.output
