# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, discovery

from ros2component import api, verb


class LoadVerb(verb.VerbExtension):
    """Load a component into a container node."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        verb.add_container(parser, 'Container node name to load component into')
        api.add_component_arguments(parser)
        arguments.add_flags(parser, {'-q --quiet': 'Only print component unique IDs and names'})

    def main(self, *, args: argparse.Namespace) -> None:
        container = verb.find_container(args)
        from ros2cli.node.direct import command_node

        with command_node(args) as node:
            uid, name = verb.load(node, container, args)
        if args.quiet:
            print(f'{uid}  {name}')
        else:
            print(f"Loaded component {uid} into '{container}' container node as '{name}'")
