# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate a Husky in the playpen."""

import atexit

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
SHARE = FindPackageShare('husky_sim')
PLAYPEN = PathJoinSubstitution([SHARE, 'worlds', 'playpen.xml'])
DEFAULTS = PathJoinSubstitution([SHARE, 'config', 'husky_sim.yaml'])
ROBOTS = "Several robots, as a list of 'NAME X Y YAW'; else one at x, y, yaw"


class NotHeadless(NotSubstitution):
    """The default of viewer, of which `--show-args` would show the address of an object."""

    def __init__(self) -> None:
        super().__init__(LaunchConfiguration('headless'))

    def describe(self) -> str:
        return 'not headless'


# Name, default, type as a parameter of the simulator or of the view, description.
ARGUMENTS = (
    ('namespace', '', None, 'Namespace of all topics but /clock'),
    ('headless', 'true', None, 'false: show the browser view'),
    ('viewer', NotHeadless(), None, 'true: the same as headless:=false'),
    ('viewer_host', '127.0.0.1', str, 'Address to serve the view at; 0.0.0.0 lets others look'),
    ('viewer_port', '8080', int, 'Port of the view; the next free one if it is taken'),
    ('viewer_names', '', str, 'More names of this machine that the view is served under'),
    ('world', PLAYPEN, str, 'World to simulate, an MJCF file'),
    ('params_file', DEFAULTS, None, 'Parameters, as YAML; what is given beside it counts more'),
    ('robots', "['']", list[str], ROBOTS),
    ('x', '0.0', float, 'Where the robot starts in the frame world, m'),
    ('y', '0.0', float, 'Where the robot starts in the frame world, m'),
    ('yaw', '0.0', float, 'Heading of the robot at the start, rad'),
    ('real_time_factor', '1.0', float, 'Simulated seconds a second; 0.0: as fast as possible'),
    ('lockstep', 'false', bool, 'true: advance one control period for each command'),
    ('interface', 'lab', str, "lab, or clearpath: a real A200's topics beside the lab's"),
    ('floor', 'asphalt', str, 'ideal, asphalt, concrete_indoor, wet, gravel or grass'),
    ('realistic', 'false', bool, "true: the original's noise and unequal loads"),
    ('seed', '0', int, 'Seed of the noise; the same seed gives the same run'),
    ('battery', 'false', bool, 'true: motors with a limit of power, and a battery that runs down'),
    ('battery_charge', '1.0', float, 'How full the battery is at the start, from 0.0 to 1.0'),
    ('lidar_rate_hz', '0.0', float, 'Rate of front/scan; 0.0: off'),
    ('camera_rate_hz', '0.0', float, 'Rate of camera/image_raw; 0.0: off'),
    ('limit_sec', '0.0', float, 'End after so much simulated time, s; 0.0: never'),
    ('record', '', str, 'File for the record of the run, written as it goes; empty: none'),
)


def _clean_at_the_end(*_: object) -> None:
    atexit.register(clean_shared_memory)


def _end_all(event: ProcessExited, context: LaunchContext) -> Shutdown | None:
    if event.returncode < 0:  # it leaves its shared memory, which others use until they end
        _clean_at_the_end()
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
            on_exit=_clean_at_the_end,  # one that is busy ends hard, with status 0
        )
        for package in packages
    ]


class _Simulator:
    """Starts the simulator; a default of an argument leaves what the file of parameters says."""

    def __init__(self, parameters: dict[str, ParameterValue]) -> None:
        self._parameters = parameters
        self._given: dict[str, ParameterValue] = {}

    def note_given(self, context: LaunchContext) -> None:
        """Remember what is given; called before the defaults are set."""
        known = context.launch_configurations
        self._given = {name: self._parameters[name] for name in self._parameters if name in known}

    def start(self, _context: LaunchContext) -> list[Node]:
        return [
            Node(
                package='husky_sim',
                executable='husky_sim',
                namespace=LaunchConfiguration('namespace'),
                output='screen',
                # Not by `parameters`: of a file that is not there launch warns alone, and goes on.
                ros_arguments=['--params-file', LaunchConfiguration('params_file')],
                parameters=[self._given],
                on_exit=_end_all,
            )
        ]


def generate_launch_description() -> LaunchDescription:
    """Return the simulator and, if requested, its view in the browser."""
    parameters = {
        name: ParameterValue(LaunchConfiguration(name), value_type=kind)
        for name, _, kind, _ in ARGUMENTS
        if kind is not None
    }
    page = {name: parameters.pop(name) for name in ('viewer_host', 'viewer_names', 'viewer_port')}
    simulator = _Simulator(parameters)
    return LaunchDescription(
        [
            OpaqueFunction(function=simulator.note_given),
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, default, _, description in ARGUMENTS
            ),
            OpaqueFunction(function=simulator.start),
            OpaqueFunction(
                function=_views, args=[page], condition=IfCondition(LaunchConfiguration('viewer'))
            ),
        ]
    )
