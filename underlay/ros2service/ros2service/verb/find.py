# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

from ros2cli import listing


class FindVerb(listing.FindVerb):
    """Output a list of available services of a given type."""

    KIND = 'service'
    TYPE = 'std_srvs/srv/Empty'
