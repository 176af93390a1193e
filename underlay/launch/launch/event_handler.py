# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is done when an event comes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TYPE_CHECKING

from .event import Event
from .some_entities_type import SomeEntitiesType

if TYPE_CHECKING:
    from .launch_context import LaunchContext
    from .launch_description_entity import LaunchDescriptionEntity


class BaseEventHandler:
    """Handles the events that its matcher accepts.

    :param handle_once: the handler takes itself away at its first event.
    """

    def __init__(self, *, matcher: Callable[[Event], bool], handle_once: bool = False) -> None:
        self.__matcher = matcher
        self.__handle_once = handle_once

    @property
    def handle_once(self) -> bool:
        return self.__handle_once

    @property
    def handler_description(self) -> str:
        return self.__class__.__name__

    @property
    def matcher_description(self) -> str:
        return getattr(self.__matcher, '__name__', '<lambda>')

    def matches(self, event: Event) -> bool:
        return self.__matcher(event)

    def describe(self) -> tuple[str, list[Any]]:
        text = (
            f"{self.__class__.__name__}(matcher='{self.matcher_description}', "
            f"handler='{self.handler_description}', handle_once={self.__handle_once})"
        )
        return text, []

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Put the event into the locals; subclasses then return what is to be visited."""
        context.extend_locals({'event': event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return None


class EventHandler(BaseEventHandler):
    """Yields entities when an event comes."""

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self.__entities = entities

    @property
    def entities(self) -> SomeEntitiesType | None:
        return self.__entities

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        from .utilities import normalize_to_list_of_entities

        entities = [] if self.__entities is None else [self.__entities]
        return super().describe()[0], normalize_to_list_of_entities(entities)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return self.entities
