# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Remember the environment."""

from __future__ import annotations

from ..action import Action
from ..launch_context import LaunchContext


class PushEnvironment(Action):
    """Puts a copy of the environment on a stack."""

    def execute(self, context: LaunchContext) -> None:
        context._push_environment()
