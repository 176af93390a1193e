# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of other nodes: their values as YAML, and the services that get and set them."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterDescriptor, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import parameter_value_to_python
from ros2_diagnosis import nearest
from ros2cli import arguments, discovery
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node, CommandNode
from ros2service import services
from rtps_graph import names
from rtps_graph.graph import Node, Role
import yaml

TYPE_NAMES = {
    ParameterType.PARAMETER_NOT_SET: 'not set',
    ParameterType.PARAMETER_BOOL: 'boolean',
    ParameterType.PARAMETER_INTEGER: 'integer',
    ParameterType.PARAMETER_DOUBLE: 'double',
    ParameterType.PARAMETER_STRING: 'string',
    ParameterType.PARAMETER_BYTE_ARRAY: 'byte array',
    ParameterType.PARAMETER_BOOL_ARRAY: 'boolean array',
    ParameterType.PARAMETER_INTEGER_ARRAY: 'integer array',
    ParameterType.PARAMETER_DOUBLE_ARRAY: 'double array',
    ParameterType.PARAMETER_STRING_ARRAY: 'string array',
}
_INT64 = range(-(2**63), 2**63)


def add_arguments(parser: argparse.ArgumentParser, *, node_is_optional: bool = False) -> None:
    """Add the options and the node of a verb."""
    discovery.add_arguments(parser)
    arguments.add_node(
        parser, nargs='?' if node_is_optional else None, help='Name of the ROS node'
    )
    arguments.add_flags(parser, {'--include-hidden-nodes': 'Consider hidden nodes as well'})
    parser.add_argument(
        '--timeout',
        metavar='N',
        type=arguments.nonnegative_float,
        default=1.0,
        help='Wait for N seconds until node becomes available (default %(default)s sec)',
    )


def add_parameter(parser: argparse.ArgumentParser, name: str, **options: Any) -> None:
    """Add the argument that names parameters of the node."""
    arguments.add_completed(parser, name, _parameters, **options)


def _parameters(args: argparse.Namespace) -> list[str]:
    with command_node() as node:
        return names_of(node, find_node(args))


def nodes(args: argparse.Namespace) -> list[Node]:
    """List the nodes that the options let be considered."""
    return [
        node
        for node in discovery.read_graph(args).nodes
        if args.include_hidden_nodes or not node.is_hidden
    ]


def nodes_named(args: argparse.Namespace) -> list[Node]:
    """List the nodes of the name that the arguments give; several may share it.

    :raises CommandError: there is none.
    """
    known = nodes(args)
    name = names.expand(args.node_name)
    found = [node for node in known if node.full_name == name]
    if not found:
        hint = nearest.hint(name, (node.full_name for node in known))
        raise CommandError(f"Node not found: '{args.node_name}'{hint}")
    return found


def find_node(args: argparse.Namespace) -> str:
    """Return the full name of the node.

    :raises CommandError: it is not there, or has no parameter services.
    """
    node = nodes_named(args)[-1]
    if not has_parameters(node):
        raise CommandError(
            f"Node '{node.full_name}' offers no parameters (it has no parameter services)"
        )
    return node.full_name


def has_parameters(node: Node) -> bool:
    return f'{node.full_name}/list_parameters' in node.having(Role.SERVER)


def names_of(node: CommandNode, node_name: str, prefixes: Sequence[str] = ()) -> list[str]:
    response = _call(node, node_name, ListParameters, 'list_parameters', prefixes=prefixes)
    return sorted(response.result.names)


def get(node: CommandNode, node_name: str, parameters: list[str]) -> list[ParameterValue]:
    response = _call(node, node_name, GetParameters, 'get_parameters', names=parameters)
    return list(response.values)


def describe(
    node: CommandNode, node_name: str, parameters: list[str]
) -> list[ParameterDescriptor]:
    response = _call(node, node_name, DescribeParameters, 'describe_parameters', names=parameters)
    return list(response.descriptors)


def set_values(node: CommandNode, node_name: str, parameters: list[Parameter]) -> list[Any]:
    response = _call(node, node_name, SetParameters, 'set_parameters', parameters=parameters)
    return list(response.results)


def set_one(args: argparse.Namespace, value: ParameterValue) -> tuple[bool, str]:
    """Set the parameter that the arguments name; return whether it is set, and a clause why."""
    node_name = find_node(args)
    with command_node(args) as node:
        parameter = Parameter(name=args.parameter_name, value=value)
        (result,) = set_values(node, node_name, [parameter])
    return result.successful, f': {result.reason}' if result.reason else ''


def _call(
    node: CommandNode, node_name: str, service_class: Any, service: str, **request: Any
) -> Any:
    name = f'{node_name}/{service}'
    return services.call(node, service_class, name, service_class.Request(**request))


def to_python(value: ParameterValue) -> Any:
    plain = parameter_value_to_python(value)
    if value.type == ParameterType.PARAMETER_BYTE_ARRAY:
        return [item[0] for item in plain]
    return list(plain) if hasattr(plain, 'typecode') or isinstance(plain, tuple) else plain


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


def from_file(name: str, value: Any) -> ParameterValue:
    """Make a parameter's value of one in a parameter file.

    :raises CommandError: it is no scalar and no list of one kind.
    """
    kinds = {type(item) for item in (value if isinstance(value, list) else [value])}
    if len(kinds) > 1 or not kinds <= {bool, int, float, str}:
        raise CommandError(
            f"parameter '{name}': {value!r} is refused; a value is true or false, a number, a "
            'string, or a list of one of these kinds'
        )
    return from_python(value, str(value))


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
