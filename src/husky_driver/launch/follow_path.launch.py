# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Follow a waypoint file with a Husky that is running already."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    share = FindPackageShare('husky_driver')
    course = PathJoinSubstitution([share, 'config', 'waypoints', 'central_barrier.yaml'])
    defaults = PathJoinSubstitution([share, 'config', 'follow_path.yaml'])
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'waypoints', default_value=course, description='Waypoint file (YAML) to follow'
            ),
            DeclareLaunchArgument(
                'namespace', default_value='', description='Namespace of the robot to drive'
            ),
            DeclareLaunchArgument(
                'use_sim_time', default_value='true', description='Take the time from /clock'
            ),
            DeclareLaunchArgument(
                'params_file', default_value=defaults, description='Parameters of follow_path'
            ),
            Node(
                package='husky_driver',
                executable='follow_path',
                namespace=LaunchConfiguration('namespace'),
                output='screen',
                emulate_tty=True,
                parameters=[
                    LaunchConfiguration('params_file'),
                    {
                        'waypoints': ParameterValue(
                            LaunchConfiguration('waypoints'), value_type=str
                        ),
                        'use_sim_time': ParameterValue(
                            LaunchConfiguration('use_sim_time'), value_type=bool
                        ),
                    },
                ],
            ),
        ]
    )
