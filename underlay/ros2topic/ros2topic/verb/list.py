# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import discovery
from ros2cli.verb import VerbExtension
from rtps_graph.graph import Graph, Role
from rtps_graph.names import is_hidden


class ListVerb(VerbExtension):
    """Output a list of available topics."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        parser.add_argument(
            '-t', '--show-types', action='store_true', help='Additionally show the topic type'
        )
        parser.add_argument(
            '-c',
            '--count-topics',
            action='store_true',
            help='Only display the number of topics discovered',
        )
        parser.add_argument(
            '--include-hidden-topics',
            '-a',
            '--all',
            action='store_true',
            default=argparse.SUPPRESS,  # else it would undo that of the command
            help='Consider hidden topics as well',
        )
        parser.add_argument(
            '-v', '--verbose', action='store_true', help='List full details about each topic'
        )

    def main(self, *, args: argparse.Namespace) -> None:
        graph = discovery.read_graph(args)
        topics = {
            name: types
            for name, types in graph.topics().items()
            if args.include_hidden_topics or not is_hidden(name)
        }
        if args.count_topics:
            print(len(topics))
        elif args.verbose:
            _print_details(graph, topics, 'Published', Role.PUBLISHER, 'publisher')
            _print_details(graph, topics, 'Subscribed', Role.SUBSCRIPTION, 'subscriber')
        else:
            for name, types in topics.items():
                print(f'{name} [{", ".join(types)}]' if args.show_types else name)


def _print_details(
    graph: Graph, topics: dict[str, list[str]], title: str, role: Role, word: str
) -> None:
    print(f'{title} topics:')
    for name, types in topics.items():
        number = len(graph.with_role(role, name))
        if number:
            plural = 's' if number > 1 else ''
            print(f' * {name} [{", ".join(types)}] {number} {word}{plural}')
    print()
