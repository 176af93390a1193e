# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Print a topic's type."""

from __future__ import annotations

import argparse

from ros2cli import completion, discovery, names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    discovery.add_arguments(parser)
    completion.topic(
        parser.add_argument(
            'topic_name', help="Name of the ROS topic to get type (e.g. '/chatter')"
        )
    )


def main(args: argparse.Namespace) -> int:
    types = discovery.read_graph(args).topics().get(names.expand(args.topic_name), [])
    for type_name in types:
        print(type_name)
    return 0 if types else 1
