# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, listing
from rtps_graph.graph import Graph, Role


class ListVerb(listing.ListVerb):
    """Output a list of available topics."""

    KIND = 'topic'

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        super().add_arguments(parser, cli_name)
        arguments.add_flags(parser, {'-v --verbose': 'List full details about each topic'})

    def show(self, graph: Graph, args: argparse.Namespace) -> None:
        if args.count or not args.verbose:
            super().show(graph, args)
            return
        for title, role, word in (
            ('Published', Role.PUBLISHER, 'publisher'),
            ('Subscribed', Role.SUBSCRIPTION, 'subscriber'),
        ):
            print(f'{title} topics:')
            for name, types in self.chosen(graph, args).items():
                number = len(graph.with_role(role, name))
                if number:
                    plural = 's' if number > 1 else ''
                    print(f' * {name} [{", ".join(types)}] {number} {word}{plural}')
            print()
