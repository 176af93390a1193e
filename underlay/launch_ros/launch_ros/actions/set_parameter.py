# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Set a parameter of every node."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.frontend import Entity, expose_action, Parser
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType

from ..utilities import evaluate_parameter_dict, normalize_parameter_dict


@expose_action('set_parameter')
class SetParameter(Action):
    """Sets a parameter of the nodes that follow in its scope; their own settings win."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        name = tuple(name) if isinstance(name, list) else name
        self.__param_dict = normalize_parameter_dict({name: value})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        kwargs['name'] = parser.parse_substitution(entity.get_attr('name'))
        kwargs['value'] = parser.parse_if_substitutions(
            entity.get_attr('value', data_type=None, can_be_str=True)
        )
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        values = evaluate_parameter_dict(context, self.__param_dict)
        # A new list: an enclosing scope keeps its own.
        known = context.launch_configurations.get('global_params', [])
        context.launch_configurations['global_params'] = [*known, *values.items()]
