# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator's settings as ROS parameters."""

from dataclasses import fields, replace
import math
import re
from typing import Any, TypeVar

from husky_course.robot import RobotStart
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, ParameterType
from rclpy.exceptions import InvalidParameterValueException
from rclpy.node import Node

from husky_sim.config import (
    DriveConfig,
    GRIP,
    GroundConfig,
    RunConfig,
    SensorConfig,
    SimulationConfig,
    StartConfig,
)
from husky_sim.errors import SettingError
from husky_sim.world.world import default_worlds

Config = TypeVar('Config', DriveConfig, GroundConfig, RunConfig, SensorConfig, StartConfig)

CHANGEABLE = 'real_time_factor'
"""The one setting that may change while the simulation runs."""

_NAME = re.compile(r'[A-Za-z][A-Za-z0-9_]*')
_ROBOTS = (
    "Many robots, each as 'NAME X Y YAW' (m, m, rad); each gets NAME as its namespace. "
    'Empty: one robot named husky, at x, y, yaw, in the namespace of the node.'
)


def read_run(node: Node) -> RunConfig:
    """Declare and read how time passes and what is kept."""
    config = _read(node, RunConfig)
    if config.world:
        return config
    return replace(config, world=str(default_worlds() / 'playpen.xml'))


def read_simulation(node: Node, run: RunConfig) -> SimulationConfig:
    """
    Declare and read what a run is a function of.

    :raises SettingError: if a value is not allowed.
    """
    start = _read(node, StartConfig)
    drive = _read(node, DriveConfig)
    sensors = _read(node, SensorConfig)
    ground = _read(node, GroundConfig)
    if ground.slip not in GRIP:
        raise SettingError(f'slip={ground.slip!r}: one of {", ".join(GRIP)} is allowed')
    if run.lockstep and not sensors.localization:
        raise SettingError('lockstep=True needs odometry/filtered; set localization to true')
    descriptor = ParameterDescriptor(
        description=_ROBOTS, read_only=True, type=ParameterType.PARAMETER_STRING_ARRAY
    )
    lines = node.declare_parameter('robots', [''], descriptor).value
    robots = tuple(_robot(line) for line in lines if line.strip())
    return SimulationConfig(
        world=run.world,
        robots=robots or (RobotStart(x=start.x, y=start.y, yaw=start.yaw),),
        drive=drive,
        ground=ground,
        sensors=sensors,
    )


def read_factor(given: Any) -> float:
    """
    Check a new real_time_factor.

    :raises SettingError: if the value is not allowed.
    """
    entry = next(entry for entry in fields(RunConfig) if entry.name == CHANGEABLE)
    low, high = entry.metadata['low'], entry.metadata['high']
    return float(_checked(CHANGEABLE, given, entry.default, low, high))


def _robot(line: str) -> RobotStart:
    name, *pose = line.split()
    try:
        x, y, yaw = (float(word) for word in pose)
    except ValueError:
        x = y = yaw = math.nan
    if not _NAME.fullmatch(name) or not all(math.isfinite(value) for value in (x, y, yaw)):
        raise SettingError(
            f"robots: {line!r}: a robot is 'NAME X Y YAW', a name of letters, digits and _ and "
            "three numbers, as in 'husky_beta 1.0 3.0 0.5236'"
        )
    return RobotStart(name=name, x=x, y=y, yaw=yaw)


def _read(node: Node, config: type[Config]) -> Config:
    values: dict[str, Any] = {}
    for entry in fields(config):
        if not entry.metadata:
            continue
        # Typed dynamically, so that a person may write 1 for 1.0.
        descriptor = ParameterDescriptor(
            description=entry.metadata['description'],
            read_only=entry.name != CHANGEABLE,
            dynamic_typing=True,
        )
        low, high = entry.metadata['low'], entry.metadata['high']
        if low < high:
            descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
        try:
            given = node.declare_parameter(entry.name, entry.default, descriptor).value
        except InvalidParameterValueException as error:
            raise SettingError(
                f'{entry.name}: a number from {low:g} to {high:g} is allowed ({error})'
            ) from error
        values[entry.name] = _checked(entry.name, given, entry.default, low, high)
    return config(**values)


def _checked(name: str, given: Any, default: Any, low: float, high: float) -> Any:
    if isinstance(default, float):
        number = isinstance(given, (int, float)) and not isinstance(given, bool)
        if number and low <= given <= high:
            return float(given)
        raise SettingError(f'{name}={given!r}: a number from {low:g} to {high:g} is allowed')
    if type(given) is type(default):
        return given
    kinds = {bool: 'true or false', int: 'a whole number', str: 'a text'}
    kind = kinds[type(default)]
    raise SettingError(f'{name}={given!r}: {kind} is allowed')
