# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A turtle that follows a carrot, which hangs at the left of another turtle."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import ThisLaunchFileDir
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return the demo of two turtles, and the carrot."""
    demo = PythonLaunchDescriptionSource([ThisLaunchFileDir(), '/turtle_tf2_demo.launch.py'])
    return LaunchDescription(
        [
            IncludeLaunchDescription(demo, launch_arguments={'target_frame': 'carrot1'}.items()),
            Node(
                package='turtle_tf2_py',
                executable='fixed_frame_tf2_broadcaster',
                name='fixed_broadcaster',
            ),
        ]
    )
