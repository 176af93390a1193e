# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the verbs of `ros2 param` share: the node, its parameters, and values as typed."""

from __future__ import annotations

import argparse
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue, SetParametersResult
from ros2_diagnosis import nearest
from ros2cli import arguments, remote_nodes
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from rtps_graph.graph import Node, Role
import yaml

from ros2param.api import call_set_parameters, list_names, ParameterNameCompleter

_INT64 = range(-(2**63), 2**63)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options and the node of a verb."""
    remote_nodes.add_arguments(parser)
    remote_nodes.add_timeout(parser)


def add_parameter(parser: argparse.ArgumentParser, name: str, **options: Any) -> None:
    """Add the argument that names parameters of the node."""
    complete = ParameterNameCompleter()
    arguments.add_completed(parser, name, lambda args: complete('', args), **options)


def find_node(args: argparse.Namespace) -> str:
    """Return the full name of the node, waiting for it as long as the arguments say.

    :raises CommandError: it is not there, or has no parameter services.
    """
    return remote_nodes.named(args, has_parameters, lacks='offers no parameters')[-1].full_name


def has_parameters(node: Node) -> bool:
    return f'{node.full_name}/list_parameters' in node.having(Role.SERVER)


def set_one(args: argparse.Namespace, value: ParameterValue) -> SetParametersResult:
    """Set the parameter that the arguments name."""
    node_name = find_node(args)
    with command_node(args) as node:
        parameter = Parameter(name=args.parameter_name, value=value)
        (result,) = call_set_parameters(
            node=node, node_name=node_name, parameters=[parameter]
        ).results
        if not result.successful:
            result.reason += _what_to_write(value, result.reason) or near_names(
                node, node_name, args.parameter_name
            )
    return result


def near_names(node: Any, node_name: str, name: str) -> str:
    """Return a clause for an error message: the parameters that may be meant by a missing one."""
    names = list_names(node=node, node_name=node_name)
    return '' if name in names else nearest.hint(name, names)


def _what_to_write(value: ParameterValue, reason: str) -> str:
    if value.type == ParameterType.PARAMETER_INTEGER and "expected 'Type.DOUBLE'" in reason:
        return f'; write {value.integer_value}.0'
    return ''


def from_text(text: str) -> ParameterValue:
    """Read a value as YAML does; what is no YAML, or no value of a parameter, is a string.

    :raises CommandError: a number or a string that ROS 2 cannot carry.
    """
    try:
        value = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError):
        value = text
    return from_python(value, text)


def from_python(value: Any, text: str) -> ParameterValue:
    """Make a parameter's value of one that YAML read; `text` is how it was written."""
    kinds = (
        (bool, 'bool', ParameterType.PARAMETER_BOOL, ParameterType.PARAMETER_BOOL_ARRAY),
        (int, 'integer', ParameterType.PARAMETER_INTEGER, ParameterType.PARAMETER_INTEGER_ARRAY),
        (float, 'double', ParameterType.PARAMETER_DOUBLE, ParameterType.PARAMETER_DOUBLE_ARRAY),
        (str, 'string', ParameterType.PARAMETER_STRING, ParameterType.PARAMETER_STRING_ARRAY),
    )
    for kind, field, single, several in kinds:
        items = value if isinstance(value, list) else [value]
        if items and all(type(item) is kind for item in items):
            for item in items:
                _check(item)
            if isinstance(value, list):
                return ParameterValue(type=several, **{f'{field}_array_value': value})
            return ParameterValue(type=single, **{f'{field}_value': value})
    if value == []:
        return ParameterValue(type=ParameterType.PARAMETER_BOOL_ARRAY)
    _check(text)
    return ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=text)


def _check(item: Any) -> None:
    if isinstance(item, int) and item not in _INT64:
        raise CommandError(f'{item} is refused: an integer parameter has 64 bits')
    if isinstance(item, str):
        if '\0' in item:
            raise CommandError(f'{item!r} is refused: a string cannot hold the character NUL')
        try:
            item.encode()
        except UnicodeEncodeError:
            raise CommandError(f'{item!r} is refused: it cannot be encoded in UTF-8') from None
