# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Start a talker and a listener; here those in Python, which have the same names and topic."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
            Node(package='demo_nodes_py', executable=executable, output='screen')
            for executable in ('talker', 'listener')
        ]
    )
