# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Have lifecycle nodes take transitions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
import contextlib
from typing import Any, TYPE_CHECKING

from launch.action import Action
from launch.actions import EmitEvent, OpaqueFunction, RegisterEventHandler
from launch.event import Event
from launch.frontend import Entity, expose_action, Parser
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.logging import get_logger
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..event_handlers import OnStateTransition

_SHUTDOWN = {'start_state': 'shuttingdown', 'goal_state': 'finalized'}


@expose_action('lifecycle_transition')
class LifecycleTransition(Action):
    """Has each of some lifecycle nodes take transitions, one after the other.

    :param lifecycle_node_names: of LifecycleNode actions, with their namespaces.
    :param transition_ids: of ``lifecycle_msgs.msg.Transition``.
    """

    # The states that a transition leads through, by its id in lifecycle_msgs/msg/Transition.
    transition_targets = {
        1: {'start_state': 'configuring', 'goal_state': 'inactive'},
        2: {'start_state': 'cleaningup', 'goal_state': 'unconfigured'},
        3: {'start_state': 'activating', 'goal_state': 'active'},
        4: {'start_state': 'deactivating', 'goal_state': 'inactive'},
        5: _SHUTDOWN,
        6: _SHUTDOWN,
        7: _SHUTDOWN,
    }

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeSubstitutionsType],
        transition_ids: Iterable[int | SomeSubstitutionsType],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        names = list(lifecycle_node_names)
        ids = [str(item) if isinstance(item, int) else item for item in transition_ids]
        if not names:
            raise ValueError('No lifecycle_node_names provided.')
        if not ids:
            raise ValueError('No transition_ids provided.')
        self.__names = [normalize_to_list_of_substitutions(name) for name in names]
        self.__ids = [normalize_to_list_of_substitutions(item) for item in ids]

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        for tag, attribute, keyword in (
            ('lifecycle_node', 'name', 'lifecycle_node_names'),
            ('transition', 'id', 'transition_ids'),
        ):
            kwargs[keyword] = []
            for item in entity.get_attr(tag, data_type=list[Entity]):
                kwargs[keyword].append(parser.parse_substitution(item.get_attr(attribute)))
                item.assert_entity_completely_parsed()
        return cls, kwargs

    def __transitions(self, context: LaunchContext) -> list[int]:
        ids = []
        for subs in self.__ids:
            text = perform_substitutions(context, subs)
            if not text.strip().isdecimal():
                raise ValueError(f'expected integer for lifecycle transition, got {text}')
            ids.append(int(text))
        return ids

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        ids = self.__transitions(context)
        entities: list[LaunchDescriptionEntity] = []
        for subs in self.__names:
            entities += self.__steps(context, perform_substitutions(context, subs), ids)
        return entities

    def __steps(
        self, context: LaunchContext, node_name: str, ids: list[int]
    ) -> list[LaunchDescriptionEntity]:
        """Return what makes one node take the first transition, and each other after the last.

        Where a transition fails, the node takes none of the others.
        """
        from ..events import matches_node_name
        from ..events.lifecycle import ChangeState

        handlers: list[OnStateTransition] = []

        def forget(context: LaunchContext) -> None:
            for handler in handlers:
                with contextlib.suppress(ValueError):  # it has handled its event
                    context.unregister_event_handler(handler)

        def give_up(context: LaunchContext) -> None:
            get_logger('launch_ros.actions.lifecycle_transition').info(
                f'{node_name} takes no more transitions: one of them failed'
            )
            forget(context)

        matches = matches_node_name(node_name)
        changes = [
            EmitEvent(event=ChangeState(lifecycle_node_matcher=matches, transition_id=item))
            for item in ids
        ]
        following = [*changes[1:], OpaqueFunction(function=forget)]
        steps = [
            _on_states(matches, self.transition_targets[item], then)
            for item, then in zip(ids, following, strict=True)
        ]
        failure = _on_states(
            matches, {'goal_state': 'errorprocessing'}, OpaqueFunction(function=give_up)
        )
        handlers += [*steps, failure]
        context.register_event_handler(failure)
        return [*map(RegisterEventHandler, steps), changes[0]]


def _on_states(
    matches: Callable[[Any], bool], states: Mapping[str, str], then: Action
) -> OnStateTransition:
    """Return a handler for the first transition of a node that leads through the states."""
    from ..event_handlers import OnStateTransition
    from ..events.lifecycle import StateTransition

    def arrived(event: Event) -> bool:
        return (
            isinstance(event, StateTransition)
            and matches(event.action)
            and all(getattr(event, name) == state for name, state in states.items())
        )

    return OnStateTransition(matcher=arrived, entities=then, handle_once=True)
