# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The runner of launch tests with the mark rostest."""

from launch_testing import test_runner


class LaunchTestRunner(test_runner.LaunchTestRunner):
    """Runs launches as the runner without ROS does."""
