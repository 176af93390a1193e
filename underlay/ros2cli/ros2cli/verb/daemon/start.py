# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

from ros2cli.verb.daemon import DaemonVerb


class StartVerb(DaemonVerb):
    """Start the daemon if it isn't running."""
