# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from typing import Any

from ros2cli import arguments, discovery
from ros2cli.errors import CommandError

from ros2component import api, verb


class ListVerb(verb.VerbExtension):
    """Output a list of running containers and components."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        text = 'Name of the container node to list components from'
        verb.add_container(parser, text, nargs='?')
        arguments.add_flags(parser, {'--containers-only': 'List found containers nodes only'})

    def main(self, *, args: argparse.Namespace) -> None:
        one = args.container_node_name is not None
        found = [verb.find_container(args)] if one else api.containers(args)
        if args.containers_only:
            for name in () if one else found:
                print(name)
            return
        for name, (known, components) in _components(args, found).items():
            if one and not known:
                raise CommandError(f'{components} when listing components in {name}')
            if not one:
                print(name)
            if not known:
                print(f'{components} when listing components')
                continue
            for component in components:
                print(f'{"" if one else "  "}{component.uid}  {component.name}')


def _components(args: argparse.Namespace, found: list[str]) -> dict[str, tuple[bool, Any]]:
    if not found:
        return {}
    from ros2cli.node.direct import command_node

    with command_node(args) as node:
        return api.get_components_in_containers(node=node, remote_containers_node_names=found)
