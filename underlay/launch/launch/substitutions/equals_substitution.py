# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whether two values are equal."""

from __future__ import annotations

import math
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ..utilities.type_utils import is_substitution
from .boolean_substitution import TwoSided


def _normalize(value: Any) -> list[Substitution]:
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    if isinstance(value, bool):
        value = str(value).lower()
    return normalize_to_list_of_substitutions('' if value is None else str(value))


def _as_bool(text: str) -> bool | None:
    return {'true': True, '1': True, 'false': False, '0': False}.get(text.lower())


def _are_equal(left: str, right: str) -> bool:
    left_bool, right_bool = _as_bool(left), _as_bool(right)
    if left_bool is not None and right_bool is not None:
        return left_bool == right_bool
    try:
        return math.isclose(float(left), float(right))
    except ValueError:
        return left == right


@expose_substitution('equals')
class EqualsSubstitution(TwoSided):
    """Becomes 'true' where both are the same text, truth value or number, else 'false'."""

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(_normalize(left), _normalize(right))

    def perform(self, context: LaunchContext) -> str:
        left = perform_substitutions(context, self.left)
        right = perform_substitutions(context, self.right)
        return str(_are_equal(left, right)).lower()
