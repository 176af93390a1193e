# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Remember the launch configurations."""

from __future__ import annotations

from ..action import Action
from ..launch_context import LaunchContext


class PushLaunchConfigurations(Action):
    """Puts a copy of the launch configurations on a stack."""

    def execute(self, context: LaunchContext) -> None:
        context._push_launch_configurations()
