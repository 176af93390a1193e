# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Declare what a launch file may be told."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..action import Action
from ..frontend import Entity, expose_action, Parser
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_action('arg')
class DeclareLaunchArgument(Action):
    """Makes a launch configuration an argument of the launch file.

    Afterwards the launch configuration is set, to what the including file or the command line
    says or else to the default, or launching has failed.

    :param choices: the only values allowed.
    """

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Sequence[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name = name
        self.default_value = (
            None if default_value is None else normalize_to_list_of_substitutions(default_value)
        )
        if choices is not None and len(choices) == 0:
            raise RuntimeError(
                'Provided choices arg is empty. Use None to ignore the choice list.'
            )
        if choices and isinstance(default_value, str) and default_value not in choices:
            raise RuntimeError(
                f'Provided default_value "{default_value}" is not in provided choices '
                f'"{list(choices)}".'
            )
        self.choices = None if choices is None else list(choices)
        self.description = self.__describe(description)
        # Set and read while the arguments of a launch description are collected.
        self._conditionally_included = False

    def __describe(self, description: str | None) -> str:
        if description is None:
            return 'no description given' if not self.choices else f'One of: {self.choices}'
        if not self.choices:
            return description
        stop = '' if description.endswith('.') else '.'
        return f'{description}{stop} Valid choices are: {self.choices}'

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        kwargs['name'] = parser.escape_characters(entity.get_attr('name'))
        default_value = entity.get_attr('default', optional=True)
        if default_value is not None:
            kwargs['default_value'] = parser.parse_substitution(default_value)
        description = entity.get_attr('description', optional=True)
        if description is not None:
            kwargs['description'] = parser.escape_characters(description)
        choices = entity.get_attr('choice', data_type=list[Entity], optional=True)
        if choices is not None:
            kwargs['choices'] = [
                parser.escape_characters(choice.get_attr('value')) for choice in choices
            ]
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        if self.name not in context.launch_configurations:
            if self.default_value is None:
                raise RuntimeError(
                    f'Required launch argument "{self.name}" (description: "{self.description}") '
                    'was not provided.'
                )
            value = perform_substitutions(context, self.default_value)
            context.launch_configurations[self.name] = value
        value = context.launch_configurations[self.name]
        if self.choices is not None and value not in self.choices:
            raise RuntimeError(
                f'Argument "{self.name}" provided value "{value}" is not valid. Valid options '
                f'are: {self.choices}'
            )
