# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the launch files of the lab are given, and that nothing wrong of it is passed over."""

from pathlib import Path

from playpen_testing.processes import Processes
import pytest


@pytest.mark.parametrize(
    ('package', 'file'),
    [
        ('husky_sim', 'husky_playpen.launch.py'),
        ('husky_sim', 'multi_husky_playpen.launch.py'),
        ('husky_driver', 'follow_path.launch.py'),
    ],
)
def test_a_file_of_parameters_that_is_not_there_is_refused(
    processes: Processes, tmp_path: Path, package: str, file: str
) -> None:
    missing = tmp_path / 'nowhere.yaml'
    launch = processes.start('ros2', 'launch', package, file, f'params_file:={missing}')
    launch.wait(timeout_sec=20.0)
    (said,) = [line for line in launch.lines if 'wrong ROS arguments' in line]
    assert f"Couldn't parse params file: '--params-file {missing}'" in said
    assert 'exit code 2' in launch.output
    assert 'Traceback' not in launch.output
