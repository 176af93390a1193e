# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Actions after a while."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import Any, Protocol

from ..action import Action
from ..event import Event
from ..event_handler import EventHandler
from ..event_handlers import OnShutdown
from ..events import TimerEvent
from ..frontend import Entity, expose_action, Parser
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities.type_utils import normalize_typed_substitution, perform_typed_substitution
from .opaque_function import OpaqueFunction


class Alarm(Protocol):
    """Something under way that can be cancelled."""

    def cancel(self) -> Any: ...


@expose_action('timer')
class TimerAction(Action):
    """Executes its actions after a period, if it is not cancelled before.

    :param period: seconds.
    :param cancel_on_shutdown: the end of the launch cancels it.
    """

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        period = float(period) if isinstance(period, (int, str)) else period
        self.period = normalize_typed_substitution(period, float)
        self.actions = list(actions)
        self.__cancel_on_shutdown = normalize_typed_substitution(cancel_on_shutdown, bool)
        self.__completed: asyncio.Future[None] | None = None
        self.__alarm: Alarm | None = None
        self.__awaited: TimerEvent | None = None
        self.is_canceled = False

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        period = entity.get_attr('period', data_type=float, optional=False)
        kwargs['period'] = parser.parse_if_substitutions(period)
        kwargs['actions'] = [parser.parse_action(child) for child in entity.children]
        cancel_on_shutdown = entity.get_attr('cancel_on_shutdown', data_type=bool, optional=True)
        if cancel_on_shutdown is not None:
            kwargs['cancel_on_shutdown'] = parser.parse_if_substitutions(cancel_on_shutdown)
        return cls, kwargs

    def describe(self) -> str:
        return f'TimerAction(period={self.period}, actions=<actions>)'

    def describe_conditional_sub_entities(self) -> list[tuple[str, Any]]:
        return [(f'after {self.period} second(s)', self.actions)]

    def cancel(self) -> None:
        """Let it never come to the actions; does nothing where it already has."""
        self.is_canceled = True
        if self.__alarm is not None:
            self.__alarm.cancel()
        self.__complete()

    def reset(self) -> None:
        """Make it ready to be executed once more."""
        self.cancel()
        self.is_canceled = False
        self.__completed = None

    def __complete(self) -> None:
        if self.__completed is not None and not self.__completed.done():
            self.__completed.set_result(None)

    def handle(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the actions, when the period is over."""
        context.extend_locals({'timer_action': self})
        self.__complete()
        return [] if self.is_canceled else self.actions

    def __on_shutdown(self, event: Event, context: LaunchContext) -> None:
        del event, context
        self.cancel()

    def _start_alarm(self, context: LaunchContext, period_sec: float, event: TimerEvent) -> Alarm:
        """Have the event emitted after the period; subclasses know other clocks."""
        assert context.asyncio_loop is not None
        return context.asyncio_loop.call_later(period_sec, context.emit_event_sync, event)

    def execute(self, context: LaunchContext) -> None:
        if self.is_canceled:
            return
        assert context.asyncio_loop is not None
        period = perform_typed_substitution(context, self.period, float)
        event = self.__awaited = TimerEvent(timer_action=self)
        self.__completed = context.asyncio_loop.create_future()
        self.__alarm = self._start_alarm(context, period, event)
        # Its actions see what they would see now: the launch file, the event that led here, the
        # variables of a loop. How files include each other, which begins with _, is over then.
        known = context.get_locals_as_dict()
        kept = {name: value for name, value in known.items() if not name.startswith('_')}
        restore = OpaqueFunction(function=lambda context: context.extend_locals(kept))
        context.register_event_handler(
            EventHandler(
                matcher=lambda other: other is event is self.__awaited,  # not before a reset()
                entities=[restore, OpaqueFunction(function=self.handle)],
                handle_once=True,
            )
        )
        if perform_typed_substitution(context, self.__cancel_on_shutdown, bool):
            context.register_event_handler(OnShutdown(on_shutdown=self.__on_shutdown))

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        return self.__completed
