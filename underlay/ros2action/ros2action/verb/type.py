# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

from ros2cli import listing


class TypeVerb(listing.TypeVerb):
    """Print an action's type."""

    KIND = 'action'
    NAME_EXAMPLE = '/fibonacci'
