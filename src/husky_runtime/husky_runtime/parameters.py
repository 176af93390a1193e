# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Settings as ROS parameters, with descriptions and ranges."""

from collections.abc import Collection
from typing import Any, TypeVar

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter

from husky_runtime.command_line import absolute_path
from husky_runtime.settings import Refuse, Setting, settings_of

Settings = TypeVar('Settings')


def declare_settings(
    node: Node, kind: type[Settings], refuse: Refuse, *, files: Collection[str] = ()
) -> Settings:
    """
    Declare the settings of a dataclass on a node and return it with their values.

    :param refuse: makes the exception to raise for a value that is not allowed.
    :param files: names of those that are files; their parameters tell them by absolute paths.
    """
    values = {
        each.name: _declare(node, each, refuse, is_file=each.name in files)
        for each in settings_of(kind)
    }
    return kind(**values)


def _declare(node: Node, setting: Setting, refuse: Refuse, *, is_file: bool) -> Any:
    if node.has_parameter(setting.name):  # from the command line, without a description
        node.undeclare_parameter(setting.name)
    default = setting.default
    value = list(default) if isinstance(default, tuple) else default
    # Typed dynamically, so that a person may write 1 for 1.0.
    given = node.declare_parameter(
        setting.name, value, ParameterDescriptor(dynamic_typing=True)
    ).value
    checked = setting.checked(given, refuse)
    if is_file:
        checked = absolute_path(checked)
        node.set_parameters([Parameter(setting.name, value=checked)])
    descriptor = ParameterDescriptor(
        description=setting.description,
        read_only=not setting.changeable,
        dynamic_typing=True,
        **_range(setting),
    )
    # Only now: rclpy would refuse a value out of range in its own words.
    node.set_descriptor(setting.name, descriptor)
    return checked


def _range(setting: Setting) -> dict[str, Any]:
    """Return the part of a descriptor that says which numbers are allowed."""
    if not setting.has_range:
        return {}
    low = 0.0 if setting.or_zero else setting.low
    if isinstance(setting.default, int):
        limits = IntegerRange(from_value=int(low), to_value=int(setting.high))
        return {'integer_range': [limits]}
    limits = FloatingPointRange(from_value=low, to_value=setting.high)
    return {'floating_point_range': [limits]}
