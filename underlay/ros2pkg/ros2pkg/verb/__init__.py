# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the verbs of `ros2 pkg` share."""

from __future__ import annotations

from pathlib import Path

from ros2_diagnosis import packages
from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension

from ros2pkg.api import get_prefix_path

__all__ = ['VerbExtension']


def prefix_of(package_name: str) -> Path:
    """Return the prefix of a package.

    :raises CommandError: it is not installed; the message says why and what to do.
    """
    prefix = get_prefix_path(package_name)
    if prefix is None:
        why = packages.why_missing(package_name)
        raise CommandError(f"Package not found: '{package_name}': {why}")
    return Path(prefix)


def share_of(package_name: str) -> Path:
    return prefix_of(package_name) / 'share' / package_name
