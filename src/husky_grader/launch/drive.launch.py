# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Drive one course in the playpen: the simulator and follow_path, until one of them ends."""

from launch import LaunchContext, LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    RegisterEventHandler,
    Shutdown,
)
from launch.event_handlers import OnProcessExit
from launch.events.process import ProcessExited
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def _end_all(event: ProcessExited, context: LaunchContext) -> Shutdown | None:
    return None if context.is_shutdown else Shutdown(reason=f'{event.process_name} has ended')


def generate_launch_description() -> LaunchDescription:
    """Return the simulator, the driver, and the end of all when one has ended, however it did."""
    names = ('record', 'limit_sec', 'real_time_factor', 'lockstep', 'viewer')
    simulator = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution(
                [FindPackageShare('husky_sim'), 'launch', 'husky_playpen.launch.py']
            )
        ),
        launch_arguments={name: LaunchConfiguration(name) for name in names}.items(),
    )
    driver = Node(
        package='husky_driver',
        executable='follow_path',
        # No use_sim_time: the driver's clock is the stamps of the odometry.
        parameters=[{'startup_timeout_sec': 60.0}],
        arguments=['--waypoints', LaunchConfiguration('waypoints')],
        output='screen',
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument('waypoints', description='the waypoint file to drive'),
            DeclareLaunchArgument(
                'record', default_value='', description='where the simulator writes the run'
            ),
            DeclareLaunchArgument(
                'limit_sec', default_value='0.0', description='most simulated time; 0.0: any'
            ),
            DeclareLaunchArgument(
                'real_time_factor',
                default_value='1.0',
                description='1.0 keeps pace with the wall, 0.0 is as fast as possible',
            ),
            DeclareLaunchArgument(
                'lockstep',
                default_value='false',
                description='true: the simulator waits for each command, so that a run repeats',
            ),
            DeclareLaunchArgument(
                'viewer', default_value='false', description='true: a live view in the browser'
            ),
            simulator,
            driver,
            RegisterEventHandler(OnProcessExit(on_exit=_end_all)),
        ]
    )
