# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A node to be loaded into a container."""

from __future__ import annotations

from typing import Any

from launch.condition import Condition
from launch.conditions import IfCondition, UnlessCondition
from launch.frontend import Entity, Parser
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions

from ..utilities import normalize_parameters, normalize_remap_rules


def _optional(value: SomeSubstitutionsType | None) -> list[Substitution] | None:
    return None if value is None else normalize_to_list_of_substitutions(value)


class ComposableNode:
    """Describes a node that is a plugin of a package."""

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: Any = None,
        remappings: Any = None,
        extra_arguments: Any = None,
        condition: Condition | None = None,
    ) -> None:
        self.package = normalize_to_list_of_substitutions(package)
        self.node_plugin = normalize_to_list_of_substitutions(plugin)
        self.node_name = _optional(name)
        self.node_namespace = _optional(namespace)
        self.parameters = None if parameters is None else normalize_parameters(parameters)
        self.remappings = None if remappings is None else normalize_remap_rules(remappings)
        self.extra_arguments = (
            None if extra_arguments is None else normalize_parameters(extra_arguments)
        )
        self.__condition = condition

    @classmethod
    def parse(cls, parser: Parser, entity: Entity) -> tuple[type[ComposableNode], dict[str, Any]]:
        from ..actions.markup import parse_nested_parameters

        kwargs: dict[str, Any] = {
            'package': parser.parse_substitution(entity.get_attr('pkg')),
            'plugin': parser.parse_substitution(entity.get_attr('plugin')),
            'name': parser.parse_substitution(entity.get_attr('name')),
        }
        namespace = entity.get_attr('namespace', optional=True)
        if namespace is not None:
            kwargs['namespace'] = parser.parse_substitution(namespace)
        for name, condition in (('if', IfCondition), ('unless', UnlessCondition)):
            text = entity.get_attr(name, optional=True)
            if text is not None:
                if 'condition' in kwargs:
                    raise RuntimeError("if and unless conditions can't be used simultaneously")
                kwargs['condition'] = condition(parser.parse_substitution(text))
        parameters = entity.get_attr('param', data_type=list[Entity], optional=True)
        if parameters:
            kwargs['parameters'] = parse_nested_parameters(parameters, parser)
        arguments = parser.parse_pairs(entity, 'extra_arg', 'name', 'value')
        if arguments:
            kwargs['extra_arguments'] = [{tuple(name): value} for name, value in arguments]
        kwargs['remappings'] = parser.parse_pairs(entity, 'remap', 'from', 'to') or None
        entity.assert_entity_completely_parsed()
        return cls, kwargs

    def condition(self) -> Condition | None:
        return self.__condition

    def is_wanted(self, context: LaunchContext) -> bool:
        """Return whether the condition, if there is one, holds."""
        return self.__condition is None or self.__condition.evaluate(context)
