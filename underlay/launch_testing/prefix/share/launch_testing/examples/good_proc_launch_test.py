# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Test what a process writes while it runs, and what is left of it afterwards."""

from pathlib import Path
import sys
import unittest

from ament_index_python import get_package_prefix
from launch import LaunchDescription
from launch.actions import ExecuteProcess
import launch_testing
from launch_testing.actions import ReadyToTest
from launch_testing.asserts import assertExitCodes, assertSequentialStdout
import pytest

PROGRAM = Path(get_package_prefix('launch_testing'), 'lib/launch_testing/good_proc.py')


@pytest.mark.launch_test
def generate_test_description():
    counter = ExecuteProcess(
        cmd=[sys.executable, str(PROGRAM)], additional_env={'PYTHONUNBUFFERED': '1'}
    )
    # The second part has what tests may name as arguments.
    return LaunchDescription([counter, ReadyToTest()]), {'counter': counter}


class TestCounter(unittest.TestCase):
    """Runs while the process does; at the end of these tests the launch is shut down."""

    def test_count_to_four(self, proc_output, counter):
        for loop in range(1, 5):
            proc_output.assertWaitFor(f'Loop {loop}', counter, timeout=10, stream='stdout')


@launch_testing.post_shutdown_test()
class TestAfterwards(unittest.TestCase):
    """Runs when every process has ended."""

    def test_exit_code(self, proc_info):
        assertExitCodes(proc_info)

    def test_full_output(self, proc_output, counter):
        with assertSequentialStdout(proc_output, counter) as output:
            for line in ('Starting Up', 'Loop 1', 'Loop 2', 'Loop 3', 'Shutting Down'):
                output.assertInStdout(line)
