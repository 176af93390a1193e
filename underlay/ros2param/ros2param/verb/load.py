# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2param import params
from ros2param.api import load_parameter_file


class LoadVerb(VerbExtension):
    """Load parameter file for a node."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser)
        parser.add_argument('parameter_file', help='Parameter file')
        arguments.add_flags(
            parser,
            {'--no-use-wildcard': "Do not load parameters in the '/**' namespace into the node"},
        )

    def main(self, *, args: argparse.Namespace) -> None:
        node_name = params.find_node(args)
        with command_node(args) as node:
            load_parameter_file(
                node=node,
                node_name=node_name,
                parameter_file=args.parameter_file,
                use_wildcard=not args.no_use_wildcard,
            )
