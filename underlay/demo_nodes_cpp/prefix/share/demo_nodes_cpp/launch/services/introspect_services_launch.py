# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Start a service and its client, which tell of their calls; here one program is both."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [Node(package='demo_nodes_py', executable='introspection', output='screen')]
    )
