# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import discovery
from ros2cli.verb import VerbExtension


class ListVerb(VerbExtension):
    """Output a list of action names."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        parser.add_argument(
            '-t', '--show-types', action='store_true', help='Additionally show the action type'
        )
        parser.add_argument(
            '-c',
            '--count-actions',
            action='store_true',
            help='Only display the number of actions discovered',
        )

    def main(self, *, args: argparse.Namespace) -> None:
        actions = discovery.read_graph(args).actions()
        if args.count_actions:
            print(len(actions))
            return
        for name, types in actions.items():
            print(f'{name} [{", ".join(types)}]' if args.show_types else name)
