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
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, default, description in (
                    ('waypoints', course, 'Waypoint file (YAML) to follow'),
                    ('namespace', '', 'Namespace of the robot to drive'),
                    ('use_sim_time', 'true', 'Take the time from /clock'),
                    ('interface', 'lab', 'Topics of the robot: lab, or clearpath'),
                    ('params_file', defaults, 'Parameters of follow_path'),
                )
            ),
            Node(
                package='husky_driver',
                executable='follow_path',
                namespace=LaunchConfiguration('namespace'),
                output='screen',
                emulate_tty=True,
                # Not by `parameters`: of a file that is not there launch warns alone, and goes on.
                ros_arguments=['--params-file', LaunchConfiguration('params_file')],
                parameters=[
                    {
                        name: ParameterValue(LaunchConfiguration(name), value_type=kind)
                        for name, kind in (
                            ('waypoints', str),
                            ('use_sim_time', bool),
                            ('interface', str),
                        )
                    },
                ],
            ),
        ]
    )
