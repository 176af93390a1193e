# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

from ros2cli.command import CommandWithVerbs


class InterfaceCommand(CommandWithVerbs):
    """Show information about ROS interfaces."""

    VERB_GROUP = 'ros2interface.verb'
