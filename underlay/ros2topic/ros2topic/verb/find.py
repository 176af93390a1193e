# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import completion, discovery
from ros2cli.verb import VerbExtension
from rtps_graph.names import is_hidden


class FindVerb(VerbExtension):
    """Output a list of available topics of a given type."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        completion.message_type(
            parser.add_argument(
                'topic_type',
                help="Name of the ROS topic type to filter for (e.g. 'std_msgs/msg/String')",
            )
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

    def main(self, *, args: argparse.Namespace) -> None:
        found = [
            name
            for name, types in discovery.read_graph(args).topics().items()
            if args.topic_type in types and (args.include_hidden_topics or not is_hidden(name))
        ]
        if args.count_topics:
            print(len(found))
            return
        for name in found:
            print(name)
