# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import signal
import uuid

from ros2cli import discovery

from ros2component import api, verb


class StandaloneVerb(verb.VerbExtension):
    """Run a component into its own standalone container node."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        api.add_component_arguments(parser)
        parser.add_argument(
            '-c',
            '--container-node-name',
            default=f'standalone_container_{uuid.uuid4().hex[:12]}',
            help='Name of the standalone container node to be run',
        )

    def main(self, *, args: argparse.Namespace) -> int:
        from ros2cli.node.direct import command_node

        container = api.run_standalone_container(container_node_name=args.container_node_name)
        with command_node(args) as node:
            try:
                verb.load(node, args.container_node_name, args)
            except RuntimeError as error:
                print(f'{error}, interrupting container node')
                container.send_signal(signal.SIGINT)
        while True:
            try:
                return container.wait()
            except KeyboardInterrupt:
                pass  # The terminal has interrupted the container too: it ends by itself.
