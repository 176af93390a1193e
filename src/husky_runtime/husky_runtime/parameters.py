# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Settings as ROS parameters, with descriptions and ranges."""

from typing import Any, TypeVar

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.node import Node

from husky_runtime.settings import Refuse, Setting, settings_of

Settings = TypeVar('Settings')


def declare_settings(node: Node, kind: type[Settings], refuse: Refuse) -> Settings:
    """
    Declare the settings of a dataclass on a node and return it with their values.

    :param refuse: makes the exception to raise for a value that is not allowed.
    """
    values = {each.name: _declare(node, each, refuse) for each in settings_of(kind)}
    return kind(**values)


def _declare(node: Node, setting: Setting, refuse: Refuse) -> Any:
    if node.has_parameter(setting.name):  # from the command line, without a description
        node.undeclare_parameter(setting.name)
    default = setting.default
    value = list(default) if isinstance(default, tuple) else default
    # Typed dynamically, so that a person may write 1 for 1.0.
    given = node.declare_parameter(
        setting.name, value, ParameterDescriptor(dynamic_typing=True)
    ).value
    checked = setting.checked(given, refuse)
    limits = FloatingPointRange(from_value=setting.low, to_value=setting.high)
    descriptor = ParameterDescriptor(
        description=setting.description,
        read_only=not setting.changeable,
        dynamic_typing=True,
        floating_point_range=[limits] if setting.has_range else [],
    )
    # Only now: rclpy would refuse a value out of range in its own words.
    node.set_descriptor(setting.name, descriptor)
    return checked
