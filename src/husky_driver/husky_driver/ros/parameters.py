# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Settings as ROS parameters, with descriptions and ranges."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node

from husky_driver.ros.settings import refuse_unknown, Settings


def declare_settings(node: Node) -> Settings:
    """
    Declare the parameters on a node and return their values.

    :raises ValueError: for a parameter that does not exist or a value that is not allowed.
    """
    given = set(node.get_parameters_by_prefix(''))
    refuse_unknown(given)
    values: dict[str, Any] = {}
    for item in fields(Settings):
        if item.name in given:
            node.undeclare_parameter(item.name)  # it was declared without a description
        values[item.name] = _declare(node, item.name, item.default, item.metadata)
    return Settings(**values)


def _declare(node: Node, name: str, default: Any, metadata: Any) -> Any:
    descriptor = ParameterDescriptor(
        description=metadata['description'], read_only=name != 'waypoints'
    )
    # YAML takes a bare off for false, and so does everybody who types it.
    may_be_off = 'off' in metadata.get('choice', ())
    descriptor.dynamic_typing = may_be_off
    low, high = metadata.get('span', (0.0, 0.0))
    if isinstance(default, float):
        descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
    value = list(default) if isinstance(default, tuple) else default
    try:
        value = node.declare_parameter(name, value, descriptor).value
    except InvalidParameterTypeException:
        kinds = {str: 'text', bool: 'true or false'}
        kind = kinds.get(type(default), 'of numbers with a decimal point')
        raise ValueError(f'parameter {name} must be {kind}, as {value!r}') from None
    except InvalidParameterValueException:
        raise ValueError(f'parameter {name}: allowed is {low:g} to {high:g}') from None
    if may_be_off and value is False:
        return 'off'
    return tuple(value) if isinstance(default, tuple) else value
