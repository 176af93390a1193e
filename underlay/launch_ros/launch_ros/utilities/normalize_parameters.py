# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters in one form from whatever the user wrote."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from launch.substitution import Substitution
from launch.substitutions import TextSubstitution
from launch.utilities import normalize_to_list_of_substitutions

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue

_SCALARS = (bool, int, float, str, bytes)


def _normalize_array(value: Sequence[Any]) -> Any:
    """Return a list of scalars and tuples of substitutions, or one tuple of substitutions.

    Texts and substitutions mixed are one text, joined; for a list of texts with substitutions
    each is a list of its own.
    """
    for item in value:
        if not isinstance(item, (*_SCALARS, Substitution, Sequence)):
            raise TypeError(f'Unexpected type for an item of a parameter array: {item!r}')
    if any(isinstance(item, Substitution) for item in value):
        if not all(isinstance(item, (str, Substitution, Sequence)) for item in value):
            raise TypeError(
                f'{value!r} mixes substitutions and values: put each substitution into a list of '
                'its own to make it an item'
            )
        return tuple(normalize_to_list_of_substitutions(value))
    if any(isinstance(item, float) for item in value) and all(
        isinstance(item, (int, float)) and not isinstance(item, bool) for item in value
    ):
        return [float(item) for item in value]
    return [
        item if isinstance(item, _SCALARS) else tuple(normalize_to_list_of_substitutions(item))
        for item in value
    ]


def normalize_parameter_dict(
    parameters: Mapping[Any, Any], *, _prefix: Sequence[Substitution] | None = None
) -> dict[tuple[Substitution, ...], Any]:
    """Return parameters by name; those in inner dictionaries have names as ``outer.inner``.

    :raises TypeError: a value is none that a parameter can have.
    """
    if not isinstance(parameters, Mapping):
        raise TypeError(f'expected a dictionary of parameters, got {parameters!r}')
    normalized: dict[tuple[Substitution, ...], Any] = {}
    for key, value in parameters.items():
        name = tuple(normalize_to_list_of_substitutions(key))
        if _prefix:
            name = (*_prefix, TextSubstitution(text='.'), *name)
        if isinstance(value, Mapping):
            normalized.update(normalize_parameter_dict(value, _prefix=name))
        elif isinstance(value, (*_SCALARS, ParameterValue)):
            normalized[name] = value
        elif isinstance(value, Path):
            normalized[name] = str(value)
        elif isinstance(value, Substitution):
            normalized[name] = (value,)
        elif isinstance(value, Sequence):
            normalized[name] = _normalize_array(value)
        else:
            raise TypeError(
                f'Unexpected type for parameter value {value!r}: allowed are bool, int, float, '
                'str, bytes, lists of one of them, substitutions and dictionaries'
            )
    return normalized


def normalize_parameters(parameters: Any) -> tuple[Any, ...]:
    """Return a tuple of files, parameters and dictionaries of parameters.

    :raises TypeError: something in it is none of these.
    """
    if isinstance(parameters, (str, Mapping)) or not isinstance(parameters, Sequence):
        raise TypeError(
            f'Expecting a list of parameter files and dictionaries, got {parameters!r}'
        )
    normalized: list[Any] = []
    for item in parameters:
        if isinstance(item, Mapping):
            normalized.append(normalize_parameter_dict(item))
        elif isinstance(item, (Parameter, ParameterFile)):
            normalized.append(item)
        else:
            normalized.append(ParameterFile(item))
    return tuple(normalized)
