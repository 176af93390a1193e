# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Delete parameter."""

from __future__ import annotations

import argparse

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue

from ros2cli import params
from ros2cli.errors import CommandError
from ros2cli.node import command_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    params.add_arguments(parser)
    params.add_parameter(parser, 'parameter_name', help='Name of the parameter')


def main(args: argparse.Namespace) -> None:
    node_name = params.find_node(args)
    unset = ParameterValue(type=ParameterType.PARAMETER_NOT_SET)
    with command_node(args) as node:
        parameter = Parameter(name=args.parameter_name, value=unset)
        (result,) = params.set_values(node, node_name, [parameter])
    reason = f': {result.reason}' if result.reason else ''
    if not result.successful:
        raise CommandError(f'Deleting parameter failed{reason}')
    print(f'Deleted parameter successfully{reason}')
