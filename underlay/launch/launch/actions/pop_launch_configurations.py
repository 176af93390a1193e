# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Restore the launch configurations."""

from __future__ import annotations

from ..action import Action
from ..launch_context import LaunchContext


class PopLaunchConfigurations(Action):
    """Goes back to the launch configurations last put on the stack."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_launch_configurations()
