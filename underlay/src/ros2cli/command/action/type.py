# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Print an action's type."""

from __future__ import annotations

import argparse

from ros2cli import completion, discovery, names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    discovery.add_arguments(parser)
    completion.action_name(
        parser.add_argument(
            'action_name', help="Name of the ROS action to get type (e.g. '/fibonacci')"
        )
    )


def main(args: argparse.Namespace) -> int:
    types = discovery.read_graph(args).actions().get(names.expand(args.action_name), [])
    for type_name in types:
        print(type_name)
    return 0 if types else 1
