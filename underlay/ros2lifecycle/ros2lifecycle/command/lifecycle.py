# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

from ros2cli.command import CommandWithVerbs


class LifecycleCommand(CommandWithVerbs):
    """Various lifecycle related sub-commands."""

    VERB_GROUP = 'ros2lifecycle.verb'
