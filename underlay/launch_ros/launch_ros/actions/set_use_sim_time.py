# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let every node follow the simulated time."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.frontend import Entity, expose_action, Parser
from launch.some_substitutions_type import SomeSubstitutionsType

from ..parameter_descriptions import ParameterValue
from .set_parameter import SetParameter


@expose_action('set_use_sim_time')
class SetUseSimTime(SetParameter):
    """Sets ``use_sim_time`` of the nodes that follow in its scope."""

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__('use_sim_time', ParameterValue(value, value_type=bool), **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = Action.parse(entity, parser)[1]
        kwargs['value'] = parser.parse_if_substitutions(entity.get_attr('value', data_type=bool))
        return cls, kwargs
