# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The value of a launch configuration."""

from __future__ import annotations

from collections.abc import Iterable
import difflib
from typing import Any, cast

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import MarkupArguments, Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .substitution_failure import SubstitutionFailure


@expose_substitution('var')
class LaunchConfiguration(Substitution):
    """Becomes the value of a launch argument or other launch configuration.

    :param default: where it is not set; without it that is an error.
    """

    _arguments = MarkupArguments('variable_name', 'default', required=1, of='var substitution')

    def __init__(
        self,
        variable_name: SomeSubstitutionsType,
        *,
        default: Any | Iterable[Any] | None = None,
    ) -> None:
        self.variable_name = normalize_to_list_of_substitutions(variable_name)
        self.__default: list[Substitution] | None = None
        if default is not None:
            items = default if isinstance(default, (list, tuple)) else [default]
            self.__default = normalize_to_list_of_substitutions(
                [item if isinstance(item, Substitution) else str(item) for item in items]
            )

    def describe(self) -> str:
        return f'LaunchConfig({" + ".join(sub.describe() for sub in self.variable_name)})'

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.variable_name)
        if name in context.launch_configurations:
            return cast(str, context.launch_configurations[name])
        if self.__default is not None:
            return perform_substitutions(context, self.__default)
        near = difflib.get_close_matches(name, list(context.launch_configurations), 1)
        hint = f" (is '{near[0]}' meant?)" if near else ''
        raise SubstitutionFailure(f"launch configuration '{name}' does not exist{hint}")
