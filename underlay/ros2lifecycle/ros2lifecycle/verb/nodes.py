# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, discovery

from ros2lifecycle import verb
from ros2lifecycle.managed import is_managed


class NodesVerb(verb.VerbExtension):
    """Output a list of nodes with lifecycle."""

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
        found = [
            node.full_name
            for node in discovery.read_graph(args).nodes
            if is_managed(node) and (args.all or not node.is_hidden)
        ]
        if args.count_nodes:
            print(len(found))
            return
        for name in sorted(set(found)):
            print(name)
