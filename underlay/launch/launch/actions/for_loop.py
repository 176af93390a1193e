# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Actions, again and again."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
import inspect
from typing import Any

import yaml

from ..action import Action
from ..frontend import Entity, expose_action, Parser
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..logging import get_logger
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .opaque_function import OpaqueFunction

_Entities = list[LaunchDescriptionEntity] | None


def _warn_of_no_turn(why: str) -> None:
    get_logger('launch').warning(f'a loop starts nothing: {why}')


class _Turn(Action):
    """Executes the actions of one turn of a loop; its variables end with it."""

    def __init__(
        self, values: Mapping[str, Any], actions: Iterable[LaunchDescriptionEntity]
    ) -> None:
        super().__init__()
        self._values = values
        self._actions = list(actions)

    def execute(self, context: LaunchContext) -> _Entities:
        context._push_locals()
        context.extend_locals(self._values)
        return self._actions

    def _leave(self, context: LaunchContext) -> None:
        context._pop_locals()


@expose_action('for_each')
class ForEach(Action):
    """Executes what a function returns for each of some sets of values.

    :param input_values: YAML mappings separated by ``;``, as ``{name: a, x: 1}; {name: b}``.
    :param function: gets the values of a set by name and returns actions; in a markup file the
        actions inside use ``$(for-var name)``.
    """

    def __init__(
        self,
        input_values: SomeSubstitutionsType,
        *,
        function: Callable[..., Iterable[LaunchDescriptionEntity] | None],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._input_values = normalize_to_list_of_substitutions(input_values)
        self._function = function

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        kwargs['input_values'] = parser.parse_substitution(entity.get_attr('values'))
        children = entity.children

        def function(**values: Any) -> list[LaunchDescriptionEntity]:
            return [_Turn(values, (parser.parse_action(child) for child in children))]

        kwargs['function'] = function
        return cls, kwargs

    def execute(self, context: LaunchContext) -> _Entities:
        entities: list[LaunchDescriptionEntity] = []
        text = perform_substitutions(context, self._input_values)
        parts = [part for part in text.split(';') if part.strip()]
        if not parts:
            _warn_of_no_turn('it has no values')
        for part in parts:
            values = yaml.safe_load(part)
            if not isinstance(values, dict):
                raise ValueError(f"'{part.strip()}' is not a mapping as {{name: value}}")
            entities.extend(self.__call(values) or ())
        return entities

    def __call(self, values: dict[str, Any]) -> Iterable[LaunchDescriptionEntity] | None:
        try:
            inspect.signature(self._function).bind(**values)
        except TypeError as error:
            raise SyntaxError(f'{error}, given the values {values}') from None
        return self._function(**values)


@expose_action('for')
class ForLoop(Action):
    """Executes what a function returns for each index from 0 up to a length.

    :param function: gets the index as ``i``, by name as upstream, and returns actions; in a markup
        file the actions inside use ``$(index name)``.
    """

    def __init__(
        self,
        length: int | SomeSubstitutionsType,
        *,
        function: Callable[..., Iterable[LaunchDescriptionEntity] | None],
        name: SomeSubstitutionsType | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        length = str(length) if isinstance(length, int) else length
        self.__length = normalize_to_list_of_substitutions(length)
        self.__function = function
        self.__name = None if name is None else normalize_to_list_of_substitutions(name)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        kwargs['length'] = parser.parse_substitution(entity.get_attr('len'))
        kwargs['name'] = parser.parse_substitution(entity.get_attr('name'))
        children = entity.children

        def function(i: int) -> list[LaunchDescriptionEntity]:
            del i
            return [parser.parse_action(child) for child in children]

        kwargs['function'] = function
        return cls, kwargs

    def execute(self, context: LaunchContext) -> _Entities:
        text = perform_substitutions(context, self.__length)
        try:
            length = int(text)
        except ValueError:
            raise ValueError(f"the length of a loop is '{text}', not a whole number") from None
        name = None if self.__name is None else perform_substitutions(context, self.__name)
        entities: list[LaunchDescriptionEntity] = []
        for index in range(length):
            call = OpaqueFunction(function=lambda _context, turn=index: self.__function(i=turn))
            entities.append(_Turn({} if name is None else {name: index}, [call]))
        if length <= 0:
            _warn_of_no_turn(f'its length is {length}')
        return entities
