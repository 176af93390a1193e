# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

from ros2cli import listing


class TypeVerb(listing.TypeVerb):
    """Output a service's type."""

    KIND = 'service'
    NAME_EXAMPLE = '/add_two_ints'
