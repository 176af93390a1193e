# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Base of the actions of a launch description."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, TYPE_CHECKING

from .condition import Condition
from .launch_context import LaunchContext
from .launch_description_entity import LaunchDescriptionEntity
from .source_location import caller_location

if TYPE_CHECKING:
    from typing_extensions import Self

    from .frontend import Entity, Parser


class Action(LaunchDescriptionEntity):
    """An intent of the user, carried out when it is visited.

    :param condition: without it, or where it holds, the action is executed.
    """

    # The attributes of its element in a markup file that are text and never left out, by the
    # arguments they become.
    _attributes: ClassVar[Mapping[str, str]] = {}

    def __new__(cls, *_args: Any, **_kwargs: Any) -> Self:
        action = super().__new__(cls)
        action._location = caller_location()
        return action

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.__condition = condition

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and the keyword arguments that an entity of a launch file means."""
        from .conditions import IfCondition, UnlessCondition

        if_text = entity.get_attr('if', optional=True)
        unless_text = entity.get_attr('unless', optional=True)
        if if_text is not None and unless_text is not None:
            raise RuntimeError("if and unless conditions can't be used simultaneously")
        kwargs: dict[str, Any] = {}
        if if_text is not None:
            kwargs['condition'] = IfCondition(parser.parse_substitution(if_text))
        if unless_text is not None:
            kwargs['condition'] = UnlessCondition(parser.parse_substitution(unless_text))
        for argument, attribute in cls._attributes.items():
            kwargs[argument] = parser.parse_substitution(entity.get_attr(attribute))
        return cls, kwargs

    @property
    def condition(self) -> Condition | None:
        return self.__condition

    def describe(self) -> str:
        return self.__repr__()

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that executing the action yields."""
        return []

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return self.get_sub_entities() if self.condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Any]]:
        if self.condition is None:
            return []
        return [('Conditionally included by ' + self.describe(), self.get_sub_entities())]

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if self.__condition is not None and not self.__condition.evaluate(context):
            return None
        try:
            return self.execute(context)
        finally:
            self.__announce_completion(context)

    def __announce_completion(self, context: LaunchContext) -> None:
        from .events import ExecutionComplete

        event = ExecutionComplete(action=self)
        if not context.would_handle_event(event):
            return
        future = self.get_asyncio_future()
        if future is None:
            context.emit_event_sync(event)
        else:
            future.add_done_callback(lambda _: context.emit_event_sync(event))

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Do the work and return the entities to visit next."""
        del context
        return None
