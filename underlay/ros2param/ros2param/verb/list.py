# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import re
import sys

from ros2cli import arguments, remote_nodes
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node, CommandNode
from ros2cli.verb import VerbExtension

from ros2param import api, params


class ListVerb(VerbExtension):
    """Output a list of available parameters."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        remote_nodes.add_arguments(parser, is_optional=True)
        parser.add_argument(
            '--filter',
            metavar='REGEX',
            default='',
            help='Only list parameters whose names begin as the regular expression says',
        )
        parser.add_argument(
            '--param-prefixes',
            nargs='+',
            default=[],
            help='Only list parameters with the provided prefixes',
        )
        arguments.add_flags(parser, {'--param-type': 'Print parameter types with parameter names'})

    def main(self, *, args: argparse.Namespace) -> None:
        keep = _pattern(args.filter)
        if args.node_name:
            found = [params.find_node(args)]
        else:
            listed = remote_nodes.listed(args)
            found = [node.full_name for node in listed if params.has_parameters(node)]
        with command_node(args) as node:
            for name in found:
                try:
                    _print_parameters(node, name, args, keep)
                except CommandError as error:
                    if args.node_name:
                        raise
                    print(error, file=sys.stderr)  # The other nodes may answer.


def _pattern(text: str) -> re.Pattern[str]:
    try:
        return re.compile(text)
    except re.error as error:
        raise CommandError(f"--filter '{text}' is no regular expression: {error}") from None


def _print_parameters(
    node: CommandNode, node_name: str, args: argparse.Namespace, keep: re.Pattern[str]
) -> None:
    known = api.list_names(
        node=node,
        node_name=node_name,
        prefixes=args.param_prefixes,
        may_take_long=bool(args.node_name),  # of all nodes, the others are not kept waiting
    )
    found = [name for name in known if keep.match(name)]
    if found and not args.node_name:
        print(f'{node_name}:')
    types = dict.fromkeys(found, '')
    if found and args.param_type:
        response = api.call_describe_parameters(
            node=node, node_name=node_name, parameter_names=found
        )
        for descriptor in response.descriptors:
            kind = api.get_parameter_type_string(descriptor.type)
            types[descriptor.name] = f' (type: {kind})'
    for name, kind in types.items():
        print(f'  {name}{kind}')
