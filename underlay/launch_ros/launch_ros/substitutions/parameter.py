# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The value of a global parameter."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch.frontend import expose_substitution
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import MarkupArguments, Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_substitution('param')
class Parameter(Substitution):
    """Becomes the value that SetParameter first gave to a parameter."""

    _arguments = MarkupArguments('name', 'default', required=1, of='param substitution')

    def __init__(
        self, name: SomeSubstitutionsType, *, default: Any | Iterable[Any] | None = None
    ) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.__default: list[Substitution] | None = None
        if default is not None:
            items = default if isinstance(default, Iterable) else (default,)
            self.__default = normalize_to_list_of_substitutions(
                item if isinstance(item, Substitution) else str(item) for item in items
            )

    def describe(self) -> str:
        return f'Parameter(name={" + ".join(sub.describe() for sub in self.name)})'

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.name)
        for item in context.launch_configurations.get('global_params', []):
            if isinstance(item, tuple) and item[0] == name:
                return str(item[1])
        if self.__default is None:
            raise SubstitutionFailure(f"parameter '{name}' not found")
        return perform_substitutions(context, self.__default)
