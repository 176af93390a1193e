# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from rcl_interfaces.msg import Parameter
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2param import params


class SetVerb(VerbExtension):
    """Set parameter."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser)
        params.add_parameter(parser, 'parameter_name', help='Name of the parameter')
        parser.add_argument('value', help='Value of the parameter')

    def main(self, *, args: argparse.Namespace) -> None:
        value = params.from_text(args.value)
        node_name = params.find_node(args)
        with command_node(args) as node:
            parameter = Parameter(name=args.parameter_name, value=value)
            (result,) = params.set_values(node, node_name, [parameter])
        reason = f': {result.reason}' if result.reason else ''
        if not result.successful:
            raise CommandError(f'Setting parameter failed{reason}')
        print(f'Set parameter successful{reason}')
