# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys

from ros2cli import arguments, discovery
from ros2cli.verb import VerbExtension

from ros2node.api import has_duplicates


class ListVerb(VerbExtension):
    """Output a list of available nodes."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_flags(
            parser,
            {
                '-a --all': 'Display all nodes even hidden ones',
                '-c --count-nodes': 'Only display the number of nodes discovered',
            },
        )

    def main(self, *, args: argparse.Namespace) -> None:
        graph = discovery.read_graph(args)
        found = [node.full_name for node in graph.nodes if args.all or not node.is_hidden]
        if args.count_nodes:
            print(len(found))
            return
        if has_duplicates(found):
            print(
                'WARNING: Be aware that there are nodes in the graph that share an exact name, '
                'which can have unintended side effects.',
                file=sys.stderr,
            )
        for name in found:
            print(name)
