# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Base of handlers for events of one action."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, cast, TYPE_CHECKING

from ..event import Event
from ..event_handler import BaseEventHandler
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_entities_type import SomeEntitiesType
from ..utilities import normalize_to_list_of_entities

if TYPE_CHECKING:
    from ..action import Action
    from ..launch_context import LaunchContext


class OnActionEventBase(BaseEventHandler):
    """Handles events of a kind, of any action, of one action or of those that match.

    :param action_matcher: an action, a predicate on actions, or None for all.
    :param on_event: entities, or a function of the event and the context that returns them.
    """

    def __init__(
        self,
        *,
        action_matcher: Callable[[Any], bool] | Action | None,
        on_event: SomeEntitiesType | Callable[[Any, LaunchContext], SomeEntitiesType | None],
        target_event_cls: type[Event],
        target_action_cls: type[Action],
        **kwargs: Any,
    ) -> None:
        if not isinstance(action_matcher, target_action_cls) and not (
            callable(action_matcher) or action_matcher is None
        ):
            raise TypeError(
                f'{type(self).__name__} requires an {target_action_cls.__name__} action or a '
                f'predicate as target_action, got {action_matcher!r}'
            )
        self.__action_matcher = action_matcher
        self.__target_event_cls = target_event_cls
        self.__on_event: Callable[[Any, LaunchContext], Any] | None = None
        self.__actions_on_event: list[LaunchDescriptionEntity] = []
        if isinstance(on_event, (LaunchDescriptionEntity, Iterable)):
            self.__actions_on_event = normalize_to_list_of_entities([on_event])
        elif callable(on_event):
            self.__on_event = on_event
        elif on_event is not None:
            raise TypeError(
                f'{type(self).__name__}: {on_event!r} is neither an action, a list of actions '
                'nor a function that returns them'
            )
        super().__init__(matcher=self.__accepts, **kwargs)

    def __accepts(self, event: Event) -> bool:
        if not isinstance(event, self.__target_event_cls):
            return False
        matcher = self.__action_matcher
        action = cast(Any, event).action
        if matcher is not None and callable(matcher):
            return bool(matcher(action))
        return matcher is None or matcher is action

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        if self.__on_event is not None:
            return cast('SomeEntitiesType | None', self.__on_event(event, context))
        return self.__actions_on_event

    @property
    def handler_description(self) -> str:
        if self.__on_event is not None:
            return getattr(self.__on_event, '__name__', '<lambda>')
        return f'{self.__actions_on_event}'

    @property
    def matcher_description(self) -> str:
        what = self.__target_event_cls.__name__
        if self.__action_matcher is None:
            return f'event == {what}'
        return f'event == {what} and event.action == {self.__action_matcher!r}'

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        return super().describe()[0], self.__actions_on_event
