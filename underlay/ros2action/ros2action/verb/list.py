# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

from ros2cli import listing


class ListVerb(listing.ListVerb):
    """Output a list of action names."""

    KIND = 'action'
