# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, discovery
from ros2cli.verb import VerbExtension
from rtps_graph import names


class TypeVerb(VerbExtension):
    """Print an action's type."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_action(parser, help="Name of the ROS action to get type (e.g. '/fibonacci')")

    def main(self, *, args: argparse.Namespace) -> int:
        types = discovery.read_graph(args).actions().get(names.expand(args.action_name), [])
        for type_name in types:
            print(type_name)
        return 0 if types else 1
