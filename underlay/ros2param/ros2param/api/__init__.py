# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of other nodes: the services that list, describe, get and set them.

The node that asks, `node`, is a node of rclpy or one of ros2cli.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import sys
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue, SetParametersResult
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import parameter_dict_from_yaml_file, parameter_value_to_python
from rclpy.task import Future
from ros2cli import calls, remote_nodes
from ros2cli.errors import CommandError, ServiceTimeout
from ros2cli.node.direct import command_node
import yaml

_TYPE_NAMES = {
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


def get_parameter_type_string(parameter_type: int) -> str:
    return _TYPE_NAMES[parameter_type]


def get_value(*, parameter_value: ParameterValue) -> Any:
    """Return a value as Python has it; None for a type that ROS 2 does not know."""
    try:
        plain = parameter_value_to_python(parameter_value)
    except RuntimeError as error:
        print(error, file=sys.stderr)
        return None
    return list(plain) if hasattr(plain, 'typecode') or isinstance(plain, tuple) else plain


def call_list_parameters(
    *, node: Any, node_name: str, prefixes: Sequence[str] | None = None
) -> Future | None:
    """Ask for the names; the future is done. None where nobody offers the service."""
    future = Future()
    try:
        future.set_result(
            _call(node, node_name, ListParameters, 'list_parameters', prefixes=prefixes or [])
        )
    except ServiceTimeout:
        return None
    except CommandError as error:
        future.set_exception(error)
    return future


def list_names(
    *, node: Any, node_name: str, prefixes: Sequence[str] = (), may_take_long: bool = False
) -> list[str]:
    """List the names of the parameters in their order.

    :param may_take_long: as for `calls.call`.
    :raises CommandError: the node does not answer.
    """
    response = _call(
        node,
        node_name,
        ListParameters,
        'list_parameters',
        may_take_long=may_take_long,
        prefixes=prefixes,
    )
    return sorted(response.result.names)


def call_describe_parameters(
    *, node: Any, node_name: str, parameter_names: Sequence[str] | None = None
) -> DescribeParameters.Response:
    """Ask for descriptions.

    This and the calls below await the answer of a busy node for as long as it takes, and raise
    RuntimeError where there will be none.
    """
    names = parameter_names or []
    return _call(node, node_name, DescribeParameters, 'describe_parameters', names=names)


def call_get_parameters(
    *, node: Any, node_name: str, parameter_names: Sequence[str]
) -> GetParameters.Response:
    return _call(node, node_name, GetParameters, 'get_parameters', names=parameter_names)


def call_set_parameters(
    *, node: Any, node_name: str, parameters: Sequence[Parameter]
) -> SetParameters.Response:
    return _call(node, node_name, SetParameters, 'set_parameters', parameters=parameters)


def load_parameter_file(
    *, node: Any, node_name: str, parameter_file: str, use_wildcard: bool
) -> None:
    """Set what a file holds, whichever node it names; what is refused is told on stderr.

    :raises CommandError: it is no parameter file, or the node does not answer.
    """
    parameters = _read(parameter_file, use_wildcard=use_wildcard)
    response = call_set_parameters(node=node, node_name=node_name, parameters=parameters)
    for parameter, result in zip(parameters, response.results, strict=True):
        print_result(
            result,
            f'Set parameter {parameter.name} successful',
            f'Set parameter {parameter.name} failed',
        )


def print_result(result: SetParametersResult, successful: str, failed: str) -> None:
    """Say what became of a parameter, and why where the node told."""
    reason = f': {result.reason}' if result.reason else ''
    if result.successful:
        print(f'{successful}{reason}')
    else:
        print(f'{failed}{reason}', file=sys.stderr)


class ParameterNameCompleter:
    """Offers the names of the parameters of the node that was typed."""

    def __call__(self, prefix: str, parsed_args: argparse.Namespace, **__: Any) -> list[str]:
        (*_, remote) = remote_nodes.named(parsed_args)
        with command_node(parsed_args) as node:
            names = list_names(node=node, node_name=remote.full_name)
        return [name for name in names if name.startswith(prefix)]


def _call(
    node: Any,
    node_name: str,
    service_class: Any,
    service: str,
    *,
    may_take_long: bool = True,
    **request: Any,
) -> Any:
    return calls.call(
        node,
        service_class,
        f'{node_name}/{service}',
        service_class.Request(**request),
        may_take_long=may_take_long,
        only_asks=service_class is not SetParameters,
    )


def _read(file: str, *, use_wildcard: bool) -> list[Parameter]:
    try:
        return list(parameter_dict_from_yaml_file(file, use_wildcard).values())
    except OSError as error:
        raise CommandError(f"'{file}' cannot be read: {error.strerror}") from None
    except RuntimeError as error:
        raise CommandError(f"'{file}': {error}") from None
    except (yaml.YAMLError, UnicodeDecodeError, RecursionError) as error:
        raise CommandError(f"'{file}' is no YAML: {' '.join(str(error).split())}") from None
    except (AttributeError, TypeError, AssertionError, ValueError) as error:
        raise CommandError(
            f"'{file}' is no parameter file; its top level names nodes, and below each stands "
            f"'ros__parameters' with names and values ({' '.join(str(error).split())})"
        ) from None
