# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the node of a player or a recorder is called, and what it logs."""

from __future__ import annotations

import argparse

from rclpy.exceptions import InvalidNodeNameException
from rclpy.logging import LoggingSeverity
from rclpy.validate_node_name import validate_node_name
from ros2cli.node.direct import CommandNode

_LEVELS = ('debug', 'info', 'warn', 'error', 'fatal')


def add_log_level(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '--log-level',
        choices=_LEVELS,
        default='info',
        help='The least of what is logged (default: %(default)s).',
    )


def add_node_name(parser: argparse.ArgumentParser, default: str) -> None:
    parser.add_argument(
        '--node-name',
        type=_node_name,
        default=default,
        help='Name of the node, with which those of its services begin (default: %(default)s).',
    )


def set_log_level(node: CommandNode, level: str) -> None:
    node.node.get_logger().set_level(LoggingSeverity[level.upper()])


def _node_name(text: str) -> str:
    try:
        validate_node_name(text)
    except InvalidNodeNameException:
        message = f"'{text}' is no name of a node: letters, digits and _, beginning with no digit"
        raise argparse.ArgumentTypeError(message) from None
    return text
