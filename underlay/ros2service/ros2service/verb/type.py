# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2_diagnosis import nearest
from ros2cli import completion, discovery
from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension
from rtps_graph import names


class TypeVerb(VerbExtension):
    """Output a service's type."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        completion.service(
            parser.add_argument(
                'service_name', help="Name of the ROS service to get type (e.g. '/add_two_ints')"
            )
        )

    def main(self, *, args: argparse.Namespace) -> None:
        services = discovery.read_graph(args).services()
        name = names.expand(args.service_name)
        if name not in services:
            raise CommandError(
                f"Unknown service '{args.service_name}'{nearest.hint(name, services, at_most=0)}"
            )
        for type_name in services[name]:
            print(type_name)
