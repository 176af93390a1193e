# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import completion, discovery
from ros2cli.verb import VerbExtension
from rtps_graph import names


class InfoVerb(VerbExtension):
    """Print information about an action."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        completion.action_name(
            parser.add_argument(
                'action_name', help="Name of the ROS action to get info (e.g. '/fibonacci')"
            )
        )
        parser.add_argument(
            '-t', '--show-types', action='store_true', help='Additionally show the action type'
        )
        parser.add_argument(
            '-c',
            '--count',
            action='store_true',
            help='Only display the number of action clients and action servers',
        )

    def main(self, *, args: argparse.Namespace) -> None:
        graph, name = discovery.read_graph(args), names.expand(args.action_name)
        clients = [(n.full_name, n.action_clients()[name]) for n in graph.nodes
                   if name in n.action_clients()]  # fmt: skip
        servers = [(n.full_name, n.action_servers()[name]) for n in graph.nodes
                   if name in n.action_servers()]  # fmt: skip
        print(f'Action: {args.action_name}')
        for title, found in (('Action clients', clients), ('Action servers', servers)):
            print(f'{title}: {len(found)}')
            if not args.count:
                for node, types in found:
                    print(f'    {node} [{", ".join(types)}]' if args.show_types else f'    {node}')
