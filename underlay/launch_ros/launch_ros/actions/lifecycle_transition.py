# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Have lifecycle nodes take transitions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch.action import Action
from launch.actions import EmitEvent, RegisterEventHandler
from launch.frontend import Entity, expose_action, Parser
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

_GOALS = {
    'configure': ('configuring', 'inactive'),
    'cleanup': ('cleaningup', 'unconfigured'),
    'activate': ('activating', 'active'),
    'deactivate': ('deactivating', 'inactive'),
    'unconfigured_shutdown': ('shuttingdown', 'finalized'),
    'inactive_shutdown': ('shuttingdown', 'finalized'),
    'active_shutdown': ('shuttingdown', 'finalized'),
}


@expose_action('lifecycle_transition')
class LifecycleTransition(Action):
    """Has each of some lifecycle nodes take transitions, one after the other.

    :param lifecycle_node_names: of LifecycleNode actions, with their namespaces.
    :param transition_ids: of ``lifecycle_msgs.msg.Transition``.
    """

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
        from ..event_handlers import OnStateTransition
        from ..events.lifecycle import ChangeState, matches_node_name, StateTransition

        ids = self.__transitions(context)
        entities: list[LaunchDescriptionEntity] = []
        for subs in self.__names:
            matches = matches_node_name(perform_substitutions(context, subs))
            changes = [
                EmitEvent(event=ChangeState(lifecycle_node_matcher=matches, transition_id=item))
                for item in ids
            ]
            for item, following in zip(ids, changes[1:], strict=False):
                start, goal = _GOALS[ChangeState.valid_transitions[item]]

                def arrived(
                    event: Any, matches: Any = matches, start: str = start, goal: str = goal
                ) -> bool:
                    return (
                        isinstance(event, StateTransition)
                        and matches(event.action)
                        and (event.start_state, event.goal_state) == (start, goal)
                    )

                handler = OnStateTransition(
                    matcher=arrived, entities=[following], handle_once=True
                )
                entities.append(RegisterEventHandler(handler))
            entities.append(changes[0])
        return entities
