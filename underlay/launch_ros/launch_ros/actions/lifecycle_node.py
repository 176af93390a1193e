# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a lifecycle node."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.frontend import Entity, expose_action, Parser
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities.type_utils import normalize_typed_substitution, perform_typed_substitution

from .lifecycle_transition import LifecycleTransition
from .node import Node


@expose_action('lifecycle_node')
class LifecycleNode(Node):
    """Runs a lifecycle node, tells of its transitions and has it take some.

    Emits ``launch_ros.events.lifecycle.StateTransition`` and handles ``ChangeState``; for both it
    needs lifecycle_msgs and a ROS node in the launch.

    :param autostart: have it configured and activated at once.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.__autostart = normalize_typed_substitution(autostart, bool)
        self.__manager: Any = None

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: list[str] | None = None
    ) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser, ignore)[1]
        kwargs.setdefault('namespace', '')
        autostart = entity.get_attr('autostart', data_type=bool, optional=True)
        if autostart is not None:
            kwargs['autostart'] = parser.parse_if_substitutions(autostart)
        return cls, kwargs

    @property
    def is_lifecycle_node(self) -> bool:
        return True

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        from ..lifecycle_events import LifecycleEvents

        self._perform_substitutions(context)
        if self.UNSPECIFIED_NODE_NAME in self.node_name:
            raise RuntimeError('node_name unexpectedly incomplete for lifecycle node')
        self.__manager = LifecycleEvents(self, self.node_name, context)
        entities = super().execute(context) or []
        if perform_typed_substitution(context, self.__autostart, bool):
            from lifecycle_msgs.msg import Transition  # type: ignore[import-untyped]

            entities.append(
                LifecycleTransition(
                    lifecycle_node_names=[self.node_name],
                    transition_ids=[
                        Transition.TRANSITION_CONFIGURE,
                        Transition.TRANSITION_ACTIVATE,
                    ],
                )
            )
        return entities
