# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The nodes that a verb asks something of: how a person names them, and which there are."""

from __future__ import annotations

import argparse
from collections.abc import Callable
import time

from ros2_diagnosis import nearest
from rtps_graph import names
from rtps_graph.graph import Node

from ros2cli import arguments, discovery
from ros2cli.errors import CommandError

_POLL_SEC = 0.1


def add_arguments(parser: argparse.ArgumentParser, *, is_optional: bool = False) -> None:
    """Add the options and the node of a verb."""
    discovery.add_arguments(parser)
    arguments.add_node(parser, nargs='?' if is_optional else None, help='Name of the ROS node')
    arguments.add_flags(parser, {'--include-hidden-nodes': 'Consider hidden nodes as well'})


def add_timeout(parser: argparse.ArgumentParser) -> None:
    """Let a person say how long `named` waits for the node."""
    parser.add_argument(
        '--timeout',
        metavar='N',
        type=arguments.nonnegative_float,
        default=1.0,
        help='Wait for N seconds until node becomes available (default %(default)s sec)',
    )


def listed(args: argparse.Namespace, *, quiet: bool = False) -> list[Node]:
    """List the nodes that the options let be considered."""
    return [
        node
        for node in discovery.read_graph(args, quiet=quiet).nodes
        if getattr(args, 'include_hidden_nodes', True) or not node.is_hidden
    ]


def named(
    args: argparse.Namespace, is_meant: Callable[[Node], bool] = lambda _: True, *, lacks: str = ''
) -> list[Node]:
    """List the nodes of the name that the arguments give; several may share it.

    :param is_meant: tells whether a node has what the verb asks for.
    :param lacks: what a node of this name that is not meant does not do.
    :raises CommandError: there is none.
    """
    name = names.expand(args.node_name)
    end = time.monotonic() + getattr(args, 'timeout', 0.0)
    while True:
        is_late = time.monotonic() >= end
        known = listed(args, quiet=not is_late)
        same_name = [node for node in known if node.full_name == name]
        if found := [node for node in same_name if is_meant(node)]:
            return found
        if is_late:
            break
        time.sleep(_POLL_SEC)
    if same_name:
        raise CommandError(f"Node not found: '{args.node_name}' is there, but {lacks}")
    hint = nearest.hint(name, (node.full_name for node in known if is_meant(node)))
    raise CommandError(f"Node not found: '{args.node_name}'{hint}")
