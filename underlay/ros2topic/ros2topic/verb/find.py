# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

from ros2cli import listing


class FindVerb(listing.FindVerb):
    """Output a list of available topics of a given type."""

    KIND = 'topic'
    TYPE = 'std_msgs/msg/String'
