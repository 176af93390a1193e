# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator's settings as ROS parameters."""

from collections.abc import Iterator
from dataclasses import replace
import math
from typing import Any

from husky_course.robot import RobotStart
from husky_runtime.parameters import declare_settings
from husky_runtime.settings import names_of, refuse_unknown, Setting, settings_of
from rcl_interfaces.msg import ParameterDescriptor, ParameterType, ParameterValue
from rclpy.node import Node
from rclpy.parameter import Parameter

from husky_sim.config import (
    BodyConfig,
    DriveConfig,
    GroundConfig,
    PowerConfig,
    RunConfig,
    SensorConfig,
    SimulationConfig,
    StartConfig,
)
from husky_sim.errors import refused, SettingError
from husky_sim.world.world import default_worlds

FACTOR = next(each for each in settings_of(RunConfig) if each.changeable)
"""real_time_factor, the one setting that may change while the simulation runs."""

_ROBOTS = Setting(
    name='robots',
    default=(),
    description="Many robots, each as 'NAME X Y YAW' (m, m, rad); of several, each gets NAME as "
    'its namespace. Empty: one robot named husky, at x, y, yaw, in the namespace of the node.',
    low=0.0,
    high=0.0,
    choices=(),
    changeable=False,
    or_zero=False,
)

_KINDS = (
    *(RunConfig, StartConfig, GroundConfig, BodyConfig),
    *(PowerConfig, SensorConfig, DriveConfig),
)

SETTINGS = (*(each for kind in _KINDS for each in settings_of(kind)), _ROBOTS)
"""Every parameter of the simulator."""


class SettingsNode(Node):
    """A node that may be given an empty list: rclpy, which sees no type in it, does not start."""

    def declare_parameters(
        self, namespace: str, parameters: list[Any], ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare as `Node` does, but what was given and has no type as what may have any."""
        if ignore_override:
            untyped = ParameterDescriptor(dynamic_typing=True)
            parameters = [
                (entry[0], None, untyped) if entry[1:2] == (None,) else entry
                for entry in parameters
            ]
        return list(super().declare_parameters(namespace, parameters, ignore_override))


def read_run(node: Node) -> RunConfig:
    """
    Declare and read how time passes and what is kept; files by their absolute paths.

    :raises SettingError: if a value is not allowed, or a parameter of the node does not exist.
    """
    try:
        refuse_unknown(node.get_parameters_by_prefix(''), [each.name for each in SETTINGS])
    except ValueError as error:
        raise SettingError(str(error)) from None
    config = declare_settings(node, RunConfig, refused, files=('world', 'record'))
    if config.world:
        return config
    return replace(config, world=str(default_worlds() / 'playpen.xml'))


def read_simulation(node: Node, run: RunConfig) -> SimulationConfig:
    """
    Declare and read what a run is a function of.

    :raises SettingError: if a value is not allowed.
    """
    start = declare_settings(node, StartConfig, refused)
    drive = declare_settings(node, DriveConfig, refused)
    sensors = declare_settings(node, SensorConfig, refused)
    ground = declare_settings(node, GroundConfig, refused)
    body = declare_settings(node, BodyConfig, refused)
    power = declare_settings(node, PowerConfig, refused)
    if run.lockstep and not sensors.localization:
        raise SettingError('lockstep=True needs odometry/filtered; set localization to true')
    robots = _read_robots(node)
    return SimulationConfig(
        world=run.world,
        robots=robots or (RobotStart(x=start.x, y=start.y, yaw=start.yaw),),
        drive=drive,
        ground=ground,
        sensors=sensors,
        body=body,
        power=power,
    )


def passed_over(node: Node, config: SimulationConfig) -> Iterator[str]:
    """Yield what is given and changes nothing, or is hardly meant so."""
    power, sensors = config.power, config.sensors
    if not power.battery and power.battery_charge != PowerConfig().battery_charge:
        yield f'battery_charge={power.battery_charge} changes nothing without battery:=true'
    if not config.has_noise and sensors.seed != SensorConfig().seed:
        yield f'seed={sensors.seed} changes nothing without noise:=true or realistic:=true'
    if config.robots[0].name != RobotStart().name:
        for name in names_of(StartConfig):
            if value := node.get_parameter(name).value:
                yield f'{name}={value} changes nothing, because robots say where they start'
    for robot in config.robots:
        if abs(robot.yaw) > 2.0 * math.pi:
            yield (
                f'{robot.name}: yaw={robot.yaw} is taken for radians, more than a turn; '
                f'{robot.yaw:g} degrees are {math.radians(robot.yaw):.4f}'
            )


def read_factor(given: Any) -> float:
    """
    Check a new real_time_factor.

    :raises SettingError: if the value is not allowed.
    """
    return float(FACTOR.checked(given, refused))


def _read_robots(node: Node) -> tuple[RobotStart, ...]:
    if node.has_parameter('robots'):  # from the command line, without a description
        node.undeclare_parameter('robots')
    # Typed dynamically: rclpy would refuse another type in its own words.
    given = node.declare_parameter('robots', [''], ParameterDescriptor(dynamic_typing=True)).value
    lines = [] if given is None else given  # an empty list comes without a type
    if not isinstance(lines, list) or not all(isinstance(line, str) for line in lines):
        raise SettingError(
            f"robots={given!r}: a list of 'NAME X Y YAW' is allowed, as in "
            "robots:=\"['alpha 0 0 0', 'beta -3 -1 0.8']\""
        )
    try:
        robots = tuple(RobotStart.parse(line) for line in lines if line.strip())
    except ValueError as error:
        raise SettingError(f'robots: {error}') from None
    kind = ParameterType.PARAMETER_STRING_ARRAY
    node.set_descriptor(
        'robots',
        ParameterDescriptor(description=_ROBOTS.description, read_only=True, type=kind),
        ParameterValue(type=kind, string_array_value=['']),
    )
    return robots
