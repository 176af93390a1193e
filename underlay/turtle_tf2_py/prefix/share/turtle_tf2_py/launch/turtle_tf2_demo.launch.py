# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A turtle that follows another, or any other frame."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return turtlesim, the frames of both turtles, and what sends the second one."""
    target = LaunchConfiguration('target_frame')
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'target_frame', default_value='turtle1', description='The frame to follow.'
            ),
            Node(package='turtlesim', executable='turtlesim_node', name='sim'),
            *(
                Node(
                    package='turtle_tf2_py',
                    executable='turtle_tf2_broadcaster',
                    name=f'broadcaster{number}',
                    parameters=[{'turtlename': f'turtle{number}'}],
                )
                for number in (1, 2)
            ),
            Node(
                package='turtle_tf2_py',
                executable='turtle_tf2_listener',
                name='listener',
                parameters=[{'target_frame': target}],
            ),
        ]
    )
