# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, discovery, listing
from ros2cli.verb import VerbExtension
from rtps_graph import names
from rtps_graph.graph import Role


class InfoVerb(VerbExtension):
    """Print information about a service."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_service(
            parser, help="Name of the ROS service to get info (e.g. '/add_two_ints')"
        )

    def main(self, *, args: argparse.Namespace) -> str | None:
        graph, name = discovery.read_graph(args), names.expand(args.service_name)
        hidden = listing.asks_for_hidden(args, 'service')
        known = discovery.by_kind(graph, 'service', hidden=hidden)
        if name not in known:
            return f"Unknown service '{args.service_name}'{discovery.near(name, known)}"
        types = known[name]
        print(f'Type: {types[0] if len(types) == 1 else types}')
        print(f'Clients count: {len(graph.with_role(Role.CLIENT, name))}')
        print(f'Services count: {len(graph.with_role(Role.SERVER, name))}')
        return None
