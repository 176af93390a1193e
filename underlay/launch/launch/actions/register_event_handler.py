# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Register an event handler."""

from __future__ import annotations

from typing import Any

from ..action import Action
from ..event_handler import BaseEventHandler
from ..launch_context import LaunchContext
from ..utilities import ensure_argument_type


class RegisterEventHandler(Action):
    """Registers an event handler when it is executed."""

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        ensure_argument_type(
            event_handler, BaseEventHandler, 'event_handler', 'RegisterEventHandler'
        )
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        context.register_event_handler(self.event_handler)

    def describe_conditional_sub_entities(self) -> list[tuple[str, Any]]:
        description, entities = self.event_handler.describe()
        return [(description, entities)] if entities else []
