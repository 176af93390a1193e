# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate several Huskies in one playpen, each in a namespace of its own."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

# Places of multi_husky_playpen.launch of the original. It writes the yaws as 30 and 45 where
# radians are expected; degrees are meant.
ROBOTS = "['husky_alpha 0.0 0.0 0.0', 'husky_beta 1.0 3.0 0.5236', 'husky_gamma -3.0 -1.0 0.7854']"


def generate_launch_description() -> LaunchDescription:
    """Return the launch of one robot, with several robots as argument."""
    one = PathJoinSubstitution(
        [FindPackageShare('husky_sim'), 'launch', 'husky_playpen.launch.py']
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'robots',
                default_value=ROBOTS,
                description="The robots, as a list of 'NAME X Y YAW' (m, m, rad)",
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(one),
                launch_arguments={'robots': LaunchConfiguration('robots')}.items(),
            ),
        ]
    )
