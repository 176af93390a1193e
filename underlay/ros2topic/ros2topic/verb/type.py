# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, discovery
from ros2cli.verb import VerbExtension
from rtps_graph import names


class TypeVerb(VerbExtension):
    """Print a topic's type."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_topic(parser, help="Name of the ROS topic to get type (e.g. '/chatter')")

    def main(self, *, args: argparse.Namespace) -> int:
        types = discovery.read_graph(args).topics().get(names.expand(args.topic_name), [])
        for type_name in types:
            print(type_name)
        return 0 if types else 1
