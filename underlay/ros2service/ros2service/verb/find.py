# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import completion, discovery
from ros2cli.verb import VerbExtension
from rtps_graph.names import is_hidden


class FindVerb(VerbExtension):
    """Output a list of available services of a given type."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        completion.service_type(
            parser.add_argument(
                'service_type',
                help="Name of the ROS service type to filter for (e.g. 'std_srvs/srv/Empty')",
            )
        )
        parser.add_argument(
            '-c',
            '--count-services',
            action='store_true',
            help='Only display the number of services discovered',
        )
        parser.add_argument(
            '--include-hidden-services',
            '-a',
            '--all',
            action='store_true',
            default=argparse.SUPPRESS,  # else it would undo that of the command
            help='Consider hidden services as well',
        )

    def main(self, *, args: argparse.Namespace) -> None:
        found = [
            name
            for name, types in discovery.read_graph(args).services().items()
            if args.service_type in types and (args.include_hidden_services or not is_hidden(name))
        ]
        if args.count_services:
            print(len(found))
            return
        for name in found:
            print(name)
