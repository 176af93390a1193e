# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Load parameter file for a node."""

from __future__ import annotations

import argparse
from pathlib import Path

from rcl_interfaces.msg import Parameter
from rclpy.parameter import parameter_dict_from_yaml_file

from ros2cli import params
from ros2cli.errors import CommandError
from ros2cli.node import command_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    params.add_arguments(parser)
    parser.add_argument('parameter_file', help='Parameter file')
    parser.add_argument(
        '--no-use-wildcard',
        action='store_true',
        help="Do not load parameters in the '/**' namespace into the node",
    )


def main(args: argparse.Namespace) -> int:
    node_name = params.find_node(args)
    parameters = read(args.parameter_file, node_name, use_wildcard=not args.no_use_wildcard)
    if not parameters:
        raise CommandError(
            f"'{args.parameter_file}' has no parameters for {node_name}: its top level names the "
            "node (or '/**'), and below that stands 'ros__parameters'"
        )
    with command_node(args) as node:
        results = params.set_values(node, node_name, parameters)
    failed = 0
    for parameter, result in zip(parameters, results, strict=True):
        reason = f': {result.reason}' if result.reason else ''
        outcome = 'successful' if result.successful else 'failed'
        print(f'Set parameter {parameter.name} {outcome}{reason}')
        failed += not result.successful
    return 1 if failed else 0


def read(file: str, node_name: str, *, use_wildcard: bool) -> list[Parameter]:
    """Read the parameters of a node from a file.

    :raises CommandError: there is no such file, or it is no parameter file.
    """
    if not Path(file).is_file():
        raise CommandError(f"'{file}' is no file: a YAML file with parameters is expected")
    try:
        found = parameter_dict_from_yaml_file(file, use_wildcard, target_nodes=[node_name])
    except Exception as error:
        reason = ' '.join(str(error).split())
        raise CommandError(f"'{file}' is no parameter file: {reason}") from None
    return list(found.values())
