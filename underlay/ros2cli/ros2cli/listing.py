# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The verbs that list topics, services or actions: all of them, or those of one type."""

from __future__ import annotations

import argparse

from rtps_graph.graph import Graph
from rtps_graph.names import is_hidden

from ros2cli import arguments, discovery
from ros2cli.verb import VerbExtension

_IN_GRAPH = {'topic': Graph.topics, 'service': Graph.services, 'action': Graph.actions}


class ListVerb(VerbExtension):
    """Base of `list`."""

    KIND = ''  # 'topic', 'service' or 'action'

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_flags(parser, {'-t --show-types': f'Additionally show the {self.KIND} type'})
        self._add_options(parser)

    def main(self, *, args: argparse.Namespace) -> None:
        self.show(discovery.read_graph(args), args)

    def _add_options(self, parser: argparse.ArgumentParser) -> None:
        parser.add_argument(
            '-c',
            f'--count-{self.KIND}s',
            dest='count',
            action='store_true',
            help=f'Only display the number of {self.KIND}s discovered',
        )
        if self.KIND != 'action':
            parser.add_argument(
                f'--include-hidden-{self.KIND}s',
                '-a',
                '--all',
                action='store_true',
                default=argparse.SUPPRESS,  # else it would undo that of the command
                help=f'Consider hidden {self.KIND}s as well',
            )

    def chosen(self, graph: Graph, args: argparse.Namespace) -> dict[str, list[str]]:
        """Return what the options ask for; actions are never hidden."""
        hidden = getattr(args, f'include_hidden_{self.KIND}s', True)
        found = _IN_GRAPH[self.KIND](graph)
        return {name: types for name, types in found.items() if hidden or not is_hidden(name)}

    def show(self, graph: Graph, args: argparse.Namespace) -> None:
        found = self.chosen(graph, args)
        if args.count:
            print(len(found))
            return
        for name, types in found.items():
            print(f'{name} [{", ".join(types)}]' if args.show_types else name)


class FindVerb(ListVerb):
    """Base of `find`."""

    TYPE = ''  # an example: 'std_msgs/msg/String'

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_type(
            parser,
            'type',
            self.TYPE.split('/')[1],
            metavar=f'{self.KIND}_type',
            help=f"Name of the ROS {self.KIND} type to filter for (e.g. '{self.TYPE}')",
        )
        self._add_options(parser)
        parser.set_defaults(show_types=False)

    def chosen(self, graph: Graph, args: argparse.Namespace) -> dict[str, list[str]]:
        found = super().chosen(graph, args)
        return {name: types for name, types in found.items() if args.type in types}
