# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a path, joined."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
import os
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions


@expose_substitution('path-join')
class PathJoinSubstitution(Substitution):
    """Becomes its parts joined as a path; a part may itself be several, joined as text.

    ``PathJoinSubstitution(...) / 'more'`` is a longer path.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        self.substitutions = [normalize_to_list_of_substitutions(part) for part in substitutions]

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        return cls, {'substitutions': data}

    def __truediv__(self, part: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.substitutions, part])

    def describe(self) -> str:
        parts = [' + '.join(sub.describe() for sub in part) for part in self.substitutions]
        return f'PathJoin({", ".join(parts)})'

    def perform(self, context: LaunchContext) -> str:
        parts = [''.join(sub.perform(context) for sub in part) for part in self.substitutions]
        return os.path.join('', *parts)  # noqa: PTH118


class PathSubstitution(PathJoinSubstitution):
    """Begins a path to be continued with ``/``."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])
