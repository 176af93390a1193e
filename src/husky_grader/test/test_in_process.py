# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Driving in one process against driving as nodes over DDS."""

import os
from pathlib import Path
import signal
import subprocess
import sys

from husky_course.record import read_record, read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_grader.run.in_process import drive_route
from husky_grader.scoring.report import judge
from playpen_testing.waiting import wait_until
import pytest


@pytest.mark.timeout(60)
@pytest.mark.parametrize('name', ['straight', 'through'])
def test_one_process_drives_the_trajectory_of_two_nodes(
    name: str, domain: int, courses: Path, tmp_path: Path
) -> None:
    file = courses / 'straight.yaml'
    if name == 'through':  # into the barrier: the driver gives up
        file = tmp_path / 'through.yaml'
        file.write_text('speed: 0.6\nwaypoints: [[0, 0], [4.5, 0]]\n')
    route, record = plan_route(load_course(file)), tmp_path / 'run.record'
    environment = {
        **os.environ,
        'ROS_DOMAIN_ID': str(domain),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'FASTRTPS_DEFAULT_PROFILES_FILE': str(courses.parent / 'fastdds.xml'),
        'PYTHONPATH': ':'.join(sys.path),
    }
    node = [sys.executable, '-m', 'husky_sim.ros.node', '--ros-args', '-p', f'record:={record}']
    node += ['-p', 'lockstep:=true', '-p', 'real_time_factor:=0.0']
    simulator = subprocess.Popen(node, env=environment, start_new_session=True)
    try:
        driver = [sys.executable, '-m', 'husky_driver.follow_path', '--waypoints', str(file)]
        driver += ['--ros-args', '-p', 'startup_timeout_sec:=30.0', '-p', 'check:=off']
        code = subprocess.run(driver, env=environment, timeout=50.0).returncode
        assert code == (0 if name == 'straight' else 1)
        simulator.send_signal(signal.SIGINT)
        simulator.wait(timeout=10.0)
    finally:
        simulator.kill()
        simulator.wait()
    wait_until(record.exists, timeout_sec=5.0, what='a record of the simulator')
    over_dds = judge(read_run(read_record(record)), route)
    in_process = judge(read_run(drive_route(route)[0]), route)
    assert over_dds.trajectory_sha256 == in_process.trajectory_sha256
    assert over_dds.score == in_process.score


def test_a_world_whose_physics_breaks_down_gives_no_score(courses: Path, tmp_path: Path) -> None:
    world = tmp_path / 'world.xml'
    world.write_text(
        '<mujoco><worldbody><geom name="floor" type="plane" size="9 9 1"/><body name="gate">'
        '<joint type="slide" stiffness="1e12"/><geom size="0.1" mass="1" pos="3 0 5"/></body>'
        '</worldbody></mujoco>'
    )
    route = plan_route(load_course(courses / 'straight.yaml'))
    with pytest.raises(ValueError, match='the physics broke down at gate, and everything'):
        drive_route(route, world=str(world))
