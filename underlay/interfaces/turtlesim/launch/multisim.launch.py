# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Start two turtlesims, each in a namespace of its own."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
            Node(
                namespace=namespace,
                package='turtlesim',
                executable='turtlesim_node',
                output='screen',
            )
            for namespace in ('turtlesim1', 'turtlesim2')
        ]
    )
