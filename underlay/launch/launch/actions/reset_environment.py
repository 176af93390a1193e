# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Go back to the first environment."""

from __future__ import annotations

from typing import Any

from ..action import Action
from ..frontend import Entity, expose_action, Parser
from ..launch_context import LaunchContext


@expose_action('reset_env')
class ResetEnvironment(Action):
    """Goes back to the environment that the launch began with."""

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        return cls, super().parse(entity, parser)[1]

    def execute(self, context: LaunchContext) -> None:
        context._reset_environment()
