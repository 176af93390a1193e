# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the verbs of `ros2 multicast` share."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager

from ros2cli.arguments import positive_int
from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension

from ros2multicast.api import DEFAULT_GROUP, DEFAULT_PORT

__all__ = ['VerbExtension', 'add_group_argument', 'add_port_argument', 'positive_int']


def add_group_argument(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--group', default=DEFAULT_GROUP, help='The multicast group address')


def add_port_argument(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '--port', type=positive_int, default=DEFAULT_PORT, help='The multicast port'
    )


@contextmanager
def refusals(args: argparse.Namespace) -> Iterator[None]:
    """Say in one line what the system has against a group, a port or a ttl."""
    try:
        yield
    except (OSError, OverflowError) as error:
        reason = getattr(error, 'strerror', None) or error
        raise CommandError(
            f"multicast group '{args.group}', port {args.port} cannot be used: {reason}"
        ) from None
