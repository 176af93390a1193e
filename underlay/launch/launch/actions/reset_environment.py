# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Go back to the first environment."""

from __future__ import annotations

from ..action import Action
from ..frontend import expose_action
from ..launch_context import LaunchContext


@expose_action('reset_env')
class ResetEnvironment(Action):
    """Goes back to the environment that the launch began with."""

    def execute(self, context: LaunchContext) -> None:
        context._reset_environment()
