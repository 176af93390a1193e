# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import discovery
from ros2cli.verb import VerbExtension
from rtps_graph.names import is_hidden


class ListVerb(VerbExtension):
    """Output a list of available services."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        parser.add_argument(
            '-t', '--show-types', action='store_true', help='Additionally show the service type'
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
        services = {
            name: types
            for name, types in discovery.read_graph(args).services().items()
            if args.include_hidden_services or not is_hidden(name)
        }
        if args.count_services:
            print(len(services))
            return
        for name, types in services.items():
            print(f'{name} [{", ".join(types)}]' if args.show_types else name)
