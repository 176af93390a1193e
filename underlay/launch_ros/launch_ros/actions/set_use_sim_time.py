# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let the launch itself follow the simulated time."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.frontend import Entity, expose_action, Parser
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities.type_utils import normalize_typed_substitution, perform_typed_substitution

from ..ros_adapters import get_ros_node


@expose_action('set_use_sim_time')
class SetUseSimTime(Action):
    """Sets ``use_sim_time`` of the node that the launch itself has, for ROSTimer.

    For the nodes that are launched it is ``SetParameter('use_sim_time', True)``.
    """

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.value = normalize_typed_substitution(value, bool)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        kwargs['value'] = parser.parse_if_substitutions(entity.get_attr('value', data_type=bool))
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        from rclpy.parameter import Parameter

        value = perform_typed_substitution(context, self.value, bool)
        (result,) = get_ros_node(context).set_parameters([Parameter('use_sim_time', value=value)])
        if not result.successful:
            raise RuntimeError(f'use_sim_time of the launch was not set: {result.reason}')
