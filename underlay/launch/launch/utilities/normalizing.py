# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Lists of substitutions and entities from whatever the user wrote."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
import re
from typing import Any, TYPE_CHECKING

from ..launch_description_entity import LaunchDescriptionEntity
from ..logging import get_logger
from ..source_location import launch_file_location
from ..substitution import Substitution

if TYPE_CHECKING:
    from ..launch_context import LaunchContext

# What a substitution becomes in an f-string: by Python alone, and without a word.
_AS_PYTHON_SAYS_IT = re.compile(r'<[\w.]*\.substitutions\.[\w.]*?(\w+) object at 0x')


def _to_substitution(value: object) -> Substitution:
    if isinstance(value, Substitution):
        return value
    if isinstance(value, (str, Path)):
        from ..substitutions import TextSubstitution

        text = str(value)
        formatted = _AS_PYTHON_SAYS_IT.search(text)
        if formatted is not None and (place := launch_file_location()) is not None:
            get_logger('launch').warning(
                f'{place[0]}:{place[1]}: a {formatted[1]} has no text before the launch, so that '
                f"an f-string or str() does not help: write a list, ['text', {formatted[1]}(...)]"
            )
        return TextSubstitution(text=text)
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
