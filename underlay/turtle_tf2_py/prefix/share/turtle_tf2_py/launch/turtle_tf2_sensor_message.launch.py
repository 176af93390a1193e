# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A turtle that drives in circles and tells where it is as points, for message filters."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return turtlesim, the frames of the turtles 1 and 3, and what drives the third one."""
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'target_frame', default_value='turtle1', description='The frame to follow.'
            ),
            Node(package='turtlesim', executable='turtlesim_node', name='sim', output='screen'),
            *(
                Node(
                    package='turtle_tf2_py',
                    executable='turtle_tf2_broadcaster',
                    name=f'broadcaster{number}',
                    parameters=[{'turtlename': turtle}],
                )
                for number, turtle in enumerate(('turtle1', 'turtle3'), start=1)
            ),
            Node(
                package='turtle_tf2_py',
                executable='turtle_tf2_message_broadcaster',
                name='message_broadcaster',
            ),
        ]
    )
