# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, discovery
from ros2cli.verb import VerbExtension


class TypeVerb(VerbExtension):
    """Output a service's type."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_service(
            parser, help="Name of the ROS service to get type (e.g. '/add_two_ints')"
        )

    def main(self, *, args: argparse.Namespace) -> None:
        services = discovery.read_graph(args).services()
        print(*discovery.types_of(services, 'service', args.service_name), sep='\n')
