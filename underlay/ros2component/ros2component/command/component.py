# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

from ros2cli.command import CommandWithVerbs


class ComponentCommand(CommandWithVerbs):
    """Various component related sub-commands."""

    VERB_GROUP = 'ros2component.verb'
