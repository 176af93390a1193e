# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, discovery
from ros2cli.errors import CommandError

from ros2component import api, verb


class UnloadVerb(verb.VerbExtension):
    """Unload a component from a container node."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        verb.add_container(parser, 'Container node name to unload component from')
        parser.add_argument(
            'component_uid', type=int, nargs='+', help='Unique ID of the component to be unloaded'
        )
        arguments.add_flags(parser, {'-q --quiet': 'Only print component unique IDs'})

    def main(self, *, args: argparse.Namespace) -> None:
        container = verb.find_container(args)
        from ros2cli.node.direct import command_node

        with command_node(args) as node:
            for uid, failed, reason in api.unload_component_from_container(
                node=node, remote_container_node_name=container, component_uids=args.component_uid
            ):
                if failed:
                    raise CommandError(
                        f"Failed to unload component {uid} from '{container}' container node: "
                        f'{reason}'
                    )
                told = f"Unloaded component {uid} from '{container}' container node"
                print(uid if args.quiet else told)
