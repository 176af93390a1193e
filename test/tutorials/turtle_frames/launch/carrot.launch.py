# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The chase, after a carrot; what another launch file has is included with other arguments."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """Return the chase and the carrot."""
    chase = PathJoinSubstitution([FindPackageShare('turtle_frames'), 'launch', 'chase.launch.py'])
    return LaunchDescription(
        [
            IncludeLaunchDescription(chase, launch_arguments={'target': 'carrot'}.items()),
            Node(package='turtle_frames', executable='carrot'),
        ]
    )
