# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The Husky beside a student's program."""

from pathlib import Path

from husky_grader.lab.robot import Robot
from husky_grader.playpen import default_course
from husky_runtime.domains import OwnDomain
from playpen_testing.waiting import wait_until
import pytest

TOLD = 'my "own": world.xml\': no such file; give the path of an MJCF file (.xml)'


def test_simulator_and_driver_take_the_world_that_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    logs = [tmp_path / 'simulator.log', tmp_path / 'driver.log']
    with OwnDomain() as domain:
        # A Husky in the domain of the terminal would tell the driver of its own world.
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain.number))
        with Robot(default_course(), tmp_path, 'my "own": world.xml') as robot:
            robot.drive()
            wait_until(
                lambda: all(TOLD in log.read_text() for log in logs),
                timeout_sec=30.0,
                what=f'{TOLD} of both',
            )
    assert robot.stands
