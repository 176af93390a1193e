# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""End the launch."""

from __future__ import annotations

from typing import Any

from ..action import Action
from ..events import Shutdown as ShutdownEvent
from ..events.process import ProcessExited
from ..frontend import Entity, expose_action, Parser
from ..launch_context import LaunchContext
from ..logging import get_logger
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .emit_event import EmitEvent


@expose_action('shutdown')
class Shutdown(EmitEvent):
    """Ends the launch; as ``on_exit`` of a process it makes the process a required one."""

    def __init__(
        self, *, reason: SomeSubstitutionsType = 'reason not given', **kwargs: Any
    ) -> None:
        self.__reason = normalize_to_list_of_substitutions(reason)
        super().__init__(event=ShutdownEvent(), **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = Action.parse(entity, parser)[1]
        reason = entity.get_attr('reason', optional=True)
        if reason is not None:
            kwargs['reason'] = parser.parse_substitution(reason)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        event = context.get_locals_as_dict().get('event')
        if isinstance(event, ProcessExited):
            get_logger('launch').info(
                f'process[{event.process_name}] was required: shutting down launched system'
            )
        reason = perform_substitutions(context, self.__reason)
        context.emit_event_sync(ShutdownEvent(reason=reason))
