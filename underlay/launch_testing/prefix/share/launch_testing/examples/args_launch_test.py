# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Test with a launch argument: launch_test args_launch_test.py dut_arg:=some_word."""

from pathlib import Path
import sys
import unittest

from ament_index_python import get_package_prefix
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
import launch_testing
from launch_testing.actions import ReadyToTest
from launch_testing.asserts import assertInStdout
import pytest

PROGRAM = Path(get_package_prefix('launch_testing'), 'lib/launch_testing/terminating_proc.py')


@pytest.mark.launch_test
@launch_testing.markers.keep_alive
def generate_test_description():
    worker = ExecuteProcess(cmd=[sys.executable, str(PROGRAM), LaunchConfiguration('dut_arg')])
    declared = DeclareLaunchArgument(
        'dut_arg', default_value='default', description='Passed to the terminating process'
    )
    return LaunchDescription([declared, worker, ReadyToTest()]), {'worker': worker}


class TestWorker(unittest.TestCase):
    def test_it_ends_by_itself(self, proc_info, worker):
        proc_info.assertWaitForShutdown(worker, timeout=10)


@launch_testing.post_shutdown_test()
class TestOutput(unittest.TestCase):
    def test_it_was_called_with_the_argument(self, proc_output, test_args, worker):
        assertInStdout(proc_output, test_args.get('dut_arg', 'default'), worker)
