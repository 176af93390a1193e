# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate a Husky in the playpen."""

from ament_index_python import get_resource, get_resources
from husky_runtime.shared_memory import clean_shared_memory
from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch.conditions import IfCondition
from launch.events.process import ProcessExited
from launch.substitutions import LaunchConfiguration, NotSubstitution, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

VIEWS = 'husky_sim.view'  # the type of the resource in the ament index

# What is handed on to the simulator as parameters: name, default, type, description.
PARAMETERS = (
    ('x', '0.0', float, 'Where the robot starts in the frame world, m'),
    ('y', '0.0', float, 'Where the robot starts in the frame world, m'),
    ('yaw', '0.0', float, 'Heading of the robot at the start, rad'),
    ('real_time_factor', '1.0', float, 'Simulated seconds a second; 0.0: as fast as possible'),
    ('lockstep', 'false', bool, 'true: advance one control period for each command'),
    ('slip', 'asphalt', str, 'How the tyres grip: ideal, asphalt or gravel'),
    ('limit_sec', '0.0', float, 'End after so much simulated time, s; 0.0: never'),
    ('record', '', str, 'File for the record of the run, written as it goes; empty: none'),
)


def _end_all(event: ProcessExited, context: LaunchContext) -> Shutdown | None:
    if event.returncode < 0:
        clean_shared_memory()  # a killed process leaves its own
    return None if context.is_shutdown else Shutdown(reason='the simulator has ended')


def _views(_context: LaunchContext, page: dict[str, ParameterValue]) -> list[Node]:
    """Start the views: a package that has one registers its executable in the ament index."""
    packages = get_resources(VIEWS)
    if not packages:
        raise RuntimeError('viewer:=true needs a view, and none is installed: build husky_view')
    return [
        Node(
            package=package,
            executable=get_resource(VIEWS, package)[0].strip(),
            namespace=LaunchConfiguration('namespace'),
            output='screen',
            parameters=[page],
        )
        for package in packages
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the simulator and, if requested, its view in the browser."""
    share = FindPackageShare('husky_sim')
    playpen = PathJoinSubstitution([share, 'worlds', 'playpen.xml'])
    defaults = PathJoinSubstitution([share, 'config', 'husky_sim.yaml'])
    given = {
        name: ParameterValue(LaunchConfiguration(name), value_type=kind)
        for name, _, kind, _ in PARAMETERS
    }
    given['robots'] = ParameterValue(LaunchConfiguration('robots'), value_type=list[str])
    given['world'] = ParameterValue(LaunchConfiguration('world'), value_type=str)
    page = {
        'viewer_host': ParameterValue(LaunchConfiguration('viewer_host'), value_type=str),
        'viewer_port': ParameterValue(LaunchConfiguration('viewer_port'), value_type=int),
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'namespace', default_value='', description='Namespace of all topics but /clock'
            ),
            DeclareLaunchArgument(
                'headless', default_value='true', description='false: show the browser view'
            ),
            DeclareLaunchArgument(
                'viewer',
                default_value=NotSubstitution(LaunchConfiguration('headless')),
                description='true: the same as headless:=false',
            ),
            DeclareLaunchArgument(
                'viewer_host',
                default_value='127.0.0.1',
                description='Address to serve the view at; 0.0.0.0 lets others look',
            ),
            DeclareLaunchArgument(
                'viewer_port',
                default_value='8080',
                description='Port of the view; the next free one if it is taken',
            ),
            DeclareLaunchArgument(
                'world', default_value=playpen, description='World to simulate, an MJCF file'
            ),
            DeclareLaunchArgument(
                'params_file', default_value=defaults, description='More parameters, as YAML'
            ),
            DeclareLaunchArgument(
                'robots',
                default_value="['']",
                description="Several robots, as a list of 'NAME X Y YAW'; else one at x, y, yaw",
            ),
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, default, _, description in PARAMETERS
            ),
            Node(
                package='husky_sim',
                executable='husky_sim',
                namespace=LaunchConfiguration('namespace'),
                output='screen',
                parameters=[LaunchConfiguration('params_file'), given],
                on_exit=_end_all,
            ),
            OpaqueFunction(
                function=_views, args=[page], condition=IfCondition(LaunchConfiguration('viewer'))
            ),
        ]
    )
