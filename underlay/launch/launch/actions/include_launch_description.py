# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Include another launch file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
import difflib
import os
from pathlib import Path
import re
from typing import Any

from ..action import Action
from ..frontend import Entity, expose_action, Parser
from ..launch_context import LaunchContext
from ..launch_description import LaunchDescription
from ..launch_description_entity import LaunchDescriptionEntity
from ..launch_description_source import LaunchDescriptionSource
from ..launch_description_sources import AnyLaunchDescriptionSource
from ..logging import get_logger
from ..some_substitutions_type import SomeSubstitutionsType
from ..source_location import attach_location
from ..substitutions import TextSubstitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .set_launch_configuration import SetLaunchConfiguration

_Argument = tuple[SomeSubstitutionsType, SomeSubstitutionsType]
_NEARLY_THE_SAME = 0.75  # of 1
# What actions look up themselves, without being told to.
_READ_BY_LAUNCH = {
    *('emulate_tty', 'launch-prefix', 'launch-prefix-filter', 'sigkill_timeout'),
    *('sigterm_timeout', 'global_params', 'ros_namespace', 'ros_remaps'),
}
_PLACE = ('current_launch_file_path', 'current_launch_file_directory')
_OUTER = '_outer_launch_files'
_MOST_TIMES = 50  # that a file may include itself, until a condition ends it


@expose_action('include')
class IncludeLaunchDescription(Action):
    """Includes the launch description of a source, with arguments.

    The arguments become launch configurations and, as everything that the included file sets,
    stay so afterwards; a GroupAction around it keeps them inside.

    :param launch_description_source: a source or the path of a launch file of any kind.
    :param launch_arguments: names and values.
    """

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Iterable[_Argument] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            launch_description_source = AnyLaunchDescriptionSource(launch_description_source)
        self.launch_description_source = launch_description_source
        if isinstance(launch_arguments, dict):
            launch_arguments = launch_arguments.items()
        self.launch_arguments = tuple(launch_arguments or ())
        self.__outer_places: list[tuple[dict[str, Any], dict[str, Any]]] = []

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        file = parser.parse_substitution(entity.get_attr('file'))
        kwargs['launch_description_source'] = file
        kwargs['launch_arguments'] = [
            *parser.parse_pairs(entity, 'let', 'name', 'value'),
            *parser.parse_pairs(entity, 'arg', 'name', 'value'),
        ]
        return cls, kwargs

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        description = self.launch_description_source.try_get_launch_description_without_context()
        return [] if description is None else [description]

    def _try_get_arguments_names_without_context(self) -> list[str] | None:
        names = []
        for name, _ in self.launch_arguments:
            subs = normalize_to_list_of_substitutions(name)
            if not all(isinstance(sub, TextSubstitution) for sub in subs):
                return None
            names.append(''.join(sub.text for sub in subs if isinstance(sub, TextSubstitution)))
        return names

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        description = self.launch_description_source.get_launch_description(context)
        self.__enter_place(context)
        self.__check_arguments(context, description)
        location = self.launch_description_source.location
        if not description.entities and Path(location).is_file():
            get_logger('launch').warning(
                f'{location} starts nothing: no action has been added to its launch description'
            )
        given = [SetLaunchConfiguration(name, value) for name, value in self.launch_arguments]
        for each in given:
            each._location = self._location  # nobody has written them elsewhere
        return [*given, description]

    def __enter_place(self, context: LaunchContext) -> None:
        known = context.get_locals_as_dict()
        location = self.launch_description_source.location
        files = (*known.get(_OUTER, ()), location)
        if files.count(location) > _MOST_TIMES:
            again = ' -> '.join(dict.fromkeys(files[files.index(location) :]))
            raise RuntimeError(
                f'a launch file includes itself without end: {again} -> {location}; take that '
                'include out, or give it a condition'
            )
        # In the actions of a timer the locals are of the file that it stands in, globals are not.
        self.__outer_places.append((_place_in(context._get_globals()), _place_in(known)))
        path = Path(location).absolute()
        if path.exists():
            path = Path(os.path.normpath(path))
            place: dict[str, Any] = {_PLACE[0]: str(path), _PLACE[1]: str(path.parent)}
        else:
            place = dict.fromkeys(_PLACE, location)
        place[_OUTER] = files
        context.extend_globals(place)
        context.extend_locals(place)

    def _leave(self, context: LaunchContext) -> None:
        if self.__outer_places:  # not where a condition kept it out
            of_globals, of_locals = self.__outer_places.pop()
            context.extend_globals(of_globals)
            context.extend_locals(of_locals)

    def __check_arguments(self, context: LaunchContext, description: LaunchDescription) -> None:
        """Refuse a missing argument before anything of the file is started."""
        given = [
            perform_substitutions(context, normalize_to_list_of_substitutions(name))
            for name, _ in self.launch_arguments
        ]
        pairs = description.get_launch_arguments_with_include_launch_description_actions()
        for argument, includes in pairs:
            if argument._conditionally_included or argument.default_value is not None:
                continue
            names = set(given)
            for include in includes:
                names |= set(include._try_get_arguments_names_without_context() or ())
            if argument.name not in names:
                error = RuntimeError(
                    'Included launch description missing required argument '
                    f"'{argument.name}' (description: '{argument.description}'), given: "
                    f'[{", ".join(given)}]'
                )
                attach_location(error, argument._location)
                raise error
        self.__hint_at_undeclared(given, {argument.name for argument, _ in pairs})

    def __hint_at_undeclared(self, given: list[str], declared: set[str]) -> None:
        """Warn of an argument that the file does not know, and that it hardly can use."""
        missing = declared - set(given)
        for name in sorted(set(given) - declared):
            if near := difflib.get_close_matches(name, missing, 1, _NEARLY_THE_SAME):
                hint = f" (is '{near[0]}' meant?)"
            elif name not in _READ_BY_LAUNCH and self.__names_nowhere(name):
                hint = ' nor named there, so that it sets nothing (`--show-args` lists what does)'
            else:
                continue
            get_logger('launch').warning(
                f"launch argument '{name}' is not declared in "
                f'{self.launch_description_source.location}{hint}'
            )

    def __names_nowhere(self, name: str) -> bool:
        """Tell whether the file neither has the name in it nor includes another one."""
        try:
            text = Path(self.launch_description_source.location).read_text(errors='replace')
        except OSError:  # a description that came from no file
            return False
        is_named = re.search(rf'(?<![\w-]){re.escape(name)}(?![\w-])', text)
        return not is_named and 'include' not in text.lower()


def _place_in(known: Mapping[str, Any]) -> dict[str, Any]:
    return {_OUTER: ()} | {name: known[name] for name in (*_PLACE, _OUTER) if name in known}
