# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""When a lifecycle node has changed its state."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TYPE_CHECKING

from launch.event import Event
from launch.event_handler import EventHandler
from launch.some_entities_type import SomeEntitiesType

from ..events.lifecycle import StateTransition

if TYPE_CHECKING:
    from ..actions import LifecycleNode


class OnStateTransition(EventHandler):
    """Handles the transitions of a lifecycle node, or of any.

    :param transition: of that label only.
    :param start_state: from that state only.
    :param goal_state: to that state only.
    :param matcher: in place of the other conditions.
    """

    def __init__(
        self,
        *,
        entities: SomeEntitiesType,
        target_lifecycle_node: LifecycleNode | None = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        **kwargs: Any,
    ) -> None:
        wanted = {'transition': transition, 'start_state': start_state, 'goal_state': goal_state}

        def matches(event: Event) -> bool:
            if not isinstance(event, StateTransition):
                return False
            if target_lifecycle_node not in (None, event.action):
                return False
            return all(
                value is None or getattr(event, name) == value for name, value in wanted.items()
            )

        super().__init__(matcher=matcher or matches, entities=entities, **kwargs)
