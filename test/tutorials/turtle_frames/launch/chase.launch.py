# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A turtle that follows another one, or a carrot."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return the turtles, a frame for each, and the follower."""
    target = LaunchConfiguration('target')
    frames = [
        Node(
            package='turtle_frames',
            executable='broadcaster',
            name=f'frame_of_{turtle}',
            parameters=[{'turtle': turtle}],
        )
        for turtle in ('turtle1', 'turtle2')
    ]
    return LaunchDescription(
        [
            DeclareLaunchArgument('target', default_value='turtle1', description='What to follow'),
            Node(package='turtlesim', executable='turtlesim_node', name='sim'),
            *frames,
            Node(package='turtle_frames', executable='follower', parameters=[{'target': target}]),
        ]
    )
