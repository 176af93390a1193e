# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Lists of substitutions and entities from whatever the user wrote."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, TYPE_CHECKING

from ..launch_description_entity import LaunchDescriptionEntity
from ..substitution import Substitution

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


def _to_substitution(value: object) -> Substitution:
    if isinstance(value, Substitution):
        return value
    if isinstance(value, (str, Path)):
        from ..substitutions import TextSubstitution

        return TextSubstitution(text=str(value))
    raise TypeError(
        f'{value!r} of type {type(value).__name__} is neither text nor a Substitution: write it '
        f"as text ('{value}') or as a substitution"
    )


def normalize_to_list_of_substitutions(subs: Any) -> list[Substitution]:
    """Return substitutions whose texts, one after the other, are what was meant.

    :raises TypeError: something in it is neither text, path nor substitution.
    """
    if isinstance(subs, Iterable) and not isinstance(subs, (str, Substitution)):
        return [_to_substitution(value) for value in subs]
    return [_to_substitution(subs)]


def normalize_to_list_of_entities(entities: Iterable[Any]) -> list[LaunchDescriptionEntity]:
    """Return the entities of nested lists, flat."""
    flat: list[LaunchDescriptionEntity] = []
    for entity in entities:
        if isinstance(entity, LaunchDescriptionEntity):
            flat.append(entity)
        elif isinstance(entity, Iterable) and not isinstance(entity, str):
            flat.extend(normalize_to_list_of_entities(entity))
        else:
            raise TypeError(f'{entity!r} is not a launch action or description')
    return flat


def perform_substitutions(context: LaunchContext, subs: Iterable[Substitution]) -> str:
    """Return the joined texts of the substitutions."""
    return ''.join([context.perform_substitution(sub) for sub in subs])
