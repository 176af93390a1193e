# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The verbs that list topics, services or actions, or tell the type of one."""

from __future__ import annotations

import argparse
from typing import Any, NoReturn

from rtps_graph import names
from rtps_graph.graph import Graph

from ros2cli import arguments, discovery
from ros2cli.verb import VerbExtension


class _NotInJazzy(argparse.Action):
    """Refuse what later distributions of ROS have."""

    def __init__(self, *, kind: str, **options: Any) -> None:
        super().__init__(nargs=0, default=argparse.SUPPRESS, help=argparse.SUPPRESS, **options)
        self._kind = kind

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> NoReturn:
        spellings = '/'.join(self.option_strings)
        parser.error(f'{spellings} is not in Jazzy; use --include-hidden-{self._kind}s')


class ListVerb(VerbExtension):
    """Base of `list`."""

    KIND = ''  # 'topic', 'service' or 'action'

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        if self.KIND != 'action':  # as upstream, here and below
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
                action='store_true',
                default=argparse.SUPPRESS,  # else it would undo that of the command
                help=f'Consider hidden {self.KIND}s as well',
            )
            parser.add_argument('-a', '--all', action=_NotInJazzy, kind=self.KIND)

    def chosen(self, graph: Graph, args: argparse.Namespace) -> dict[str, list[str]]:
        """Return what the options ask for."""
        return discovery.by_kind(graph, self.KIND, hidden=asks_for_hidden(args, self.KIND))

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
        if self.KIND == 'topic':
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

    def show(self, graph: Graph, args: argparse.Namespace) -> None:
        super().show(graph, args)
        if not self.chosen(graph, args):
            known = {name for types in super().chosen(graph, args).values() for name in types}
            discovery.hint_near(f"no {self.KIND} has the type '{args.type}'", args.type, known)

    def chosen(self, graph: Graph, args: argparse.Namespace) -> dict[str, list[str]]:
        found = super().chosen(graph, args)
        return {name: types for name, types in found.items() if args.type in types}


class TypeVerb(VerbExtension):
    """Base of `type`."""

    KIND = ''  # 'topic', 'service' or 'action'
    NAME_EXAMPLE = ''

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        if self.KIND == 'topic':
            discovery.add_arguments(parser)
        add_name = {
            'topic': arguments.add_topic,
            'service': arguments.add_service,
            'action': arguments.add_action,
        }[self.KIND]
        add_name(
            parser, help=f"Name of the ROS {self.KIND} to get type (e.g. '{self.NAME_EXAMPLE}')"
        )

    def main(self, *, args: argparse.Namespace) -> int:
        graph = discovery.read_graph(args)
        name = getattr(args, f'{self.KIND}_name')
        known = discovery.by_kind(graph, self.KIND)
        types = known.get(names.expand(name), [])
        if not types:
            discovery.hint_near(f"there is no {self.KIND} '{name}'", name, known)
        elif names.is_hidden(name) and not asks_for_hidden(args, self.KIND):
            types = []
        for type_name in types:
            print(type_name)
        return 0 if types else 1


def asks_for_hidden(args: argparse.Namespace, kind: str) -> bool:
    """Tell whether hidden topics or services are wanted; actions are never hidden."""
    return bool(getattr(args, f'include_hidden_{kind}s', kind == 'action'))
