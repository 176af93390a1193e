# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import re

from ros2cli import arguments
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node, CommandNode
from ros2cli.verb import VerbExtension

from ros2param import params


class ListVerb(VerbExtension):
    """Output a list of available parameters."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser, node_is_optional=True)
        parser.add_argument(
            '--param-prefixes',
            nargs='+',
            default=[],
            help='Only list parameters with the provided prefixes',
        )
        arguments.add_flags(parser, {'--param-type': 'Print parameter types with parameter names'})
        parser.add_argument(
            '--filter', metavar='REGEX', help='Only list parameters matching the provided regex'
        )

    def main(self, *, args: argparse.Namespace) -> None:
        keep = _pattern(args.filter)
        found = params.nodes_named(args) if args.node_name else params.nodes(args)
        with command_node(args) as node:
            for each in found:
                if params.has_parameters(each):
                    if not args.node_name:
                        print(f'{each.full_name}:')
                    _print_parameters(node, each.full_name, args, keep)


def _pattern(text: str | None) -> re.Pattern[str]:
    try:
        return re.compile(text or '')
    except re.error as error:
        raise CommandError(f"--filter '{text}' is no regular expression: {error}") from None


def _print_parameters(
    node: CommandNode, node_name: str, args: argparse.Namespace, keep: re.Pattern[str]
) -> None:
    found = [
        name for name in params.names_of(node, node_name, args.param_prefixes) if keep.search(name)
    ]
    if not args.param_type:
        for name in found:
            print(f'  {name}')
        return
    for descriptor in params.describe(node, node_name, found):
        print(f'  {descriptor.name} (type: {params.TYPE_NAMES[descriptor.type]})')
