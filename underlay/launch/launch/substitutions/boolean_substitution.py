# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Not, and, or, any and all."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import MarkupArguments, Substitution
from ..utilities import normalize_to_list_of_substitutions
from ..utilities.type_utils import perform_typed_substitution
from .substitution_failure import SubstitutionFailure


def _truth(context: LaunchContext, value: list[Substitution]) -> bool:
    try:
        return bool(perform_typed_substitution(context, value, bool))
    except (TypeError, ValueError) as error:
        raise SubstitutionFailure(error) from error


def _text(truth: bool) -> str:
    return 'true' if truth else 'false'


@expose_substitution('not')
class NotSubstitution(Substitution):
    """Becomes 'true' where its value says false, and 'false' where it says true."""

    _arguments = MarkupArguments('value', of='not substitution')

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self.value = normalize_to_list_of_substitutions(value)

    def describe(self) -> str:
        return f'NotSubstitution({self.value})'

    def perform(self, context: LaunchContext) -> str:
        return _text(not _truth(context, self.value))


class TwoSided(Substitution):
    """Base of the substitutions with a left and a right value."""

    _arguments = MarkupArguments('left', 'right')

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        self.left = normalize_to_list_of_substitutions(left)
        self.right = normalize_to_list_of_substitutions(right)

    def describe(self) -> str:
        return f'{type(self).__name__}({self.left} {self.right})'


@expose_substitution('and')
class AndSubstitution(TwoSided):
    """Becomes 'true' where both values say true."""

    def perform(self, context: LaunchContext) -> str:
        return _text(all([_truth(context, self.left), _truth(context, self.right)]))


@expose_substitution('or')
class OrSubstitution(TwoSided):
    """Becomes 'true' where at least one of two values says true."""

    def perform(self, context: LaunchContext) -> str:
        return _text(any([_truth(context, self.left), _truth(context, self.right)]))


class _ManyValued(Substitution):
    """Base of the substitutions with any number of values."""

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self.args = [normalize_to_list_of_substitutions(arg) for arg in args]

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        return cls, {'args': data}

    def describe(self) -> str:
        return f'{type(self).__name__}({" ".join(str(arg) for arg in self.args)})'

    def _truths(self, context: LaunchContext) -> list[bool]:
        return [_truth(context, arg) for arg in self.args]


@expose_substitution('any')
class AnySubstitution(_ManyValued):
    """Becomes 'true' where at least one of the values says true; each has to say something."""

    def perform(self, context: LaunchContext) -> str:
        return _text(any(self._truths(context)))


@expose_substitution('all')
class AllSubstitution(_ManyValued):
    """Becomes 'true' where all of the values say true; each has to say something."""

    def perform(self, context: LaunchContext) -> str:
        return _text(all(self._truths(context)))
