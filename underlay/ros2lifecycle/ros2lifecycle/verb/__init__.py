# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the verbs of `ros2 lifecycle` share."""

from __future__ import annotations

import argparse

from ros2cli import remote_nodes
from ros2cli.verb import VerbExtension

from ros2lifecycle.managed import is_managed

__all__ = ['VerbExtension']


def find_node(args: argparse.Namespace) -> str:
    """Return the full name of the node that the arguments name.

    :raises CommandError: it is not there, or has no lifecycle.
    """
    return remote_nodes.named(args, is_managed, lacks='has no lifecycle')[-1].full_name
