# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The values that a loop gives to its actions."""

from __future__ import annotations

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import MarkupArguments, Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from .substitution_failure import SubstitutionFailure


@expose_substitution('for-var')
class ForEachVar(Substitution):
    """Becomes the value that a variable has in the present turn of a ForEach."""

    _arguments = MarkupArguments('name', 'default_value', required=1, error=ValueError)

    def __init__(
        self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None
    ) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self._default_value = (
            None if default_value is None else normalize_to_list_of_substitutions(default_value)
        )

    def describe(self) -> str:
        return f'{type(self).__name__}({" + ".join(sub.describe() for sub in self.name)})'

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.name)
        known = context.get_locals_as_dict()
        if name in known:
            return str(known[name])
        if self._default_value is not None:
            return perform_substitutions(context, self._default_value)
        raise SubstitutionFailure(f"there is no loop variable '{name}' here")


@expose_substitution('index')
class ForLoopIndex(ForEachVar):
    """Becomes the index of the present turn of a ForLoop."""
