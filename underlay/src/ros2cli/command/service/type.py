# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Output a service's type."""

from __future__ import annotations

import argparse

from ros2cli import completion, discovery, names, nearest
from ros2cli.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    discovery.add_arguments(parser)
    completion.service(
        parser.add_argument(
            'service_name', help="Name of the ROS service to get type (e.g. '/add_two_ints')"
        )
    )


def main(args: argparse.Namespace) -> None:
    services = discovery.read_graph(args).services()
    name = names.expand(args.service_name)
    if name not in services:
        raise CommandError(
            f"Unknown service '{args.service_name}'{nearest.hint(name, services, at_most=0)}"
        )
    for type_name in services[name]:
        print(type_name)
