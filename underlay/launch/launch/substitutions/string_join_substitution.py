# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Texts, joined by a delimiter."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_substitution('string-join')
class StringJoinSubstitution(Substitution):
    """Becomes its texts with the delimiter between them."""

    def __init__(
        self,
        substitutions: Iterable[SomeSubstitutionsType],
        delimiter: SomeSubstitutionsType = '',
    ) -> None:
        self.substitutions = [normalize_to_list_of_substitutions(part) for part in substitutions]
        self.delimiter = normalize_to_list_of_substitutions(delimiter)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        if len(data) < 2:
            raise TypeError('string-join substitution expects a delimiter and at least one text')
        return cls, {'delimiter': data[0], 'substitutions': data[1:]}

    def describe(self) -> str:
        parts = [' + '.join(sub.describe() for sub in part) for part in self.substitutions]
        return f'StringJoin({", ".join(parts)})'

    def perform(self, context: LaunchContext) -> str:
        delimiter = perform_substitutions(context, self.delimiter)
        return delimiter.join(perform_substitutions(context, part) for part in self.substitutions)
