# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Emit an event."""

from __future__ import annotations

from typing import Any

from ..action import Action
from ..event import Event
from ..launch_context import LaunchContext
from ..utilities import ensure_argument_type


class EmitEvent(Action):
    """Emits an event when it is executed."""

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        ensure_argument_type(event, Event, 'event', 'EmitEvent')
        self.event = event

    def execute(self, context: LaunchContext) -> None:
        context.emit_event_sync(self.event)
