# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys

from ros2cli import remote_nodes
from ros2cli.node.direct import command_node

from ros2lifecycle import verb
from ros2lifecycle.api import call_get_states
from ros2lifecycle.managed import is_managed


class GetVerb(verb.VerbExtension):
    """Get lifecycle state for one or more nodes."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        remote_nodes.add_arguments(parser, is_optional=True)

    def main(self, *, args: argparse.Namespace) -> int:
        if args.node_name:
            asked = [verb.find_node(args)]
        else:
            listed = remote_nodes.listed(args)
            asked = sorted({node.full_name for node in listed if is_managed(node)})
        with command_node(args) as node:
            states = call_get_states(node=node, node_names=asked)
        for name, state in states.items():
            if isinstance(state, Exception):
                print(state, file=sys.stderr)
            else:
                prefix = '' if args.node_name else f'{name}: '
                print(f'{prefix}{state.label} [{state.id}]')
        failed = any(isinstance(state, Exception) for state in states.values())
        return 1 if failed and args.node_name else 0
