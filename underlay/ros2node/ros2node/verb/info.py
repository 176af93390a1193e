# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys

from ros2_diagnosis import nearest
from ros2cli import arguments, discovery
from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension
from rtps_graph import names
from rtps_graph.graph import Role

from ros2node.api import INFO_NONUNIQUE_WARNING_TEMPLATE


class InfoVerb(VerbExtension):
    """Output information about a node."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_node(parser, help='Fully qualified node name to request information')
        arguments.add_flags(
            parser, {'--include-hidden': 'Display hidden topics, services, and actions as well'}
        )

    def main(self, *, args: argparse.Namespace) -> None:
        graph = discovery.read_graph(args)
        name = names.expand(args.node_name)
        known = [node for node in graph.nodes if args.include_hidden or not node.is_hidden]
        matching = [node for node in known if node.full_name == name]
        if not matching:
            hint = nearest.hint(name, (node.full_name for node in known))
            raise CommandError(f"Unable to find node '{args.node_name}'{hint}")
        if len(matching) > 1:
            print(
                INFO_NONUNIQUE_WARNING_TEMPLATE.format(num_nodes=len(matching), node_name=name),
                file=sys.stderr,
            )
        node = matching[0]
        print(name)
        for title, types in (
            ('Subscribers', node.having(Role.SUBSCRIPTION)),
            ('Publishers', node.having(Role.PUBLISHER)),
            ('Service Servers', node.having(Role.SERVER)),
            ('Service Clients', node.having(Role.CLIENT)),
            ('Action Servers', node.action_servers()),
            ('Action Clients', node.action_clients()),
        ):
            print(f'  {title}:')
            for entry, entry_types in types.items():
                if args.include_hidden or not names.is_hidden(entry):
                    print(f'    {entry}: {", ".join(entry_types)}')
            # Upstream ends an empty list with an empty line.
            if not any(args.include_hidden or not names.is_hidden(entry) for entry in types):
                print()
