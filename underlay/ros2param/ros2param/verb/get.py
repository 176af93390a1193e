# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from rcl_interfaces.msg import ParameterType
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2param import api, params


class GetVerb(VerbExtension):
    """Get parameter."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser)
        params.add_parameter(parser, 'parameter_name', help='Name of the parameter')
        parser.add_argument('--hide-type', action='store_true', help='Hide the type information')

    def main(self, *, args: argparse.Namespace) -> None:
        node_name = params.find_node(args)
        with command_node(args) as node:
            values = api.call_get_parameters(
                node=node, node_name=node_name, parameter_names=[args.parameter_name]
            ).values
            if not values:
                near = params.near_names(node, node_name, args.parameter_name)
                raise CommandError(f'Parameter not set{near}')
        value = values[0]
        if value.type == ParameterType.PARAMETER_NOT_SET:
            print('Parameter not set.')
            return
        kind, _, several = api.get_parameter_type_string(value.type).partition(' ')
        label = f'{kind.capitalize()} {"values are" if several else "value is"}: '
        print(f'{"" if args.hide_type else label}{api.get_value(parameter_value=value)}')
