# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, discovery
from ros2cli.verb import VerbExtension
from rtps_graph import names
from rtps_graph.graph import Node


class InfoVerb(VerbExtension):
    """Print information about an action."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_action(parser, help="Name of the ROS action to get info (e.g. '/fibonacci')")
        arguments.add_flags(
            parser,
            {
                '-t --show-types': 'Additionally show the action type',
                '-c --count': 'Only display the number of action clients and action servers',
            },
        )

    def main(self, *, args: argparse.Namespace) -> None:
        graph, name = discovery.read_graph(args), names.expand(args.action_name)
        print(f'Action: {args.action_name}')
        for title, actions_of in (
            ('Action clients', Node.action_clients),
            ('Action servers', Node.action_servers),
        ):
            found = [node for node in graph.nodes if name in actions_of(node)]
            print(f'{title}: {len(found)}')
            for node in [] if args.count else found:
                types = f' [{", ".join(actions_of(node)[name])}]' if args.show_types else ''
                print(f'    {node.full_name}{types}')
