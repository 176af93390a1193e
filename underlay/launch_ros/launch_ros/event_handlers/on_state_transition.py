# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""When a lifecycle node has changed its state."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from launch.event import Event
from launch.event_handler import EventHandler
from launch.some_entities_type import SomeEntitiesType

from ..actions import LifecycleNode
from ..events.lifecycle import StateTransition


class OnStateTransition(EventHandler):
    """Handles the transitions of a lifecycle node, or of any.

    :param transition: of that label only.
    :param start_state: from that state only.
    :param goal_state: to that state only.
    :param matcher: in place of the other conditions.
    :raises RuntimeError: the target is no lifecycle node.
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
        if not isinstance(target_lifecycle_node, LifecycleNode | None):
            raise RuntimeError(
                "OnStateTransition requires a 'LifecycleNode' action as the target, got "
                f'{target_lifecycle_node!r}'
            )
        self.__target = target_lifecycle_node
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

    @property
    def handler_description(self) -> str:
        return '<actions>'

    @property
    def matcher_description(self) -> str:
        if self.__target is None:
            return 'event == StateTransition'
        target = f'LifecycleNode({hex(id(self.__target))})'
        return f'event == StateTransition and event.action == {target}'
