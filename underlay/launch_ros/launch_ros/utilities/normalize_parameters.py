# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters in one form from whatever the user wrote."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
from typing import Any

from launch.substitution import Substitution
from launch.substitutions import TextSubstitution
from launch.utilities import ensure_argument_type, normalize_to_list_of_substitutions
import yaml

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue

_SCALARS = (bool, int, float, str)  # a bool is an int too
_ITEMS = (*_SCALARS, Substitution, Sequence)
_Subs = tuple[Substitution, ...]


def as_yaml(value: Any) -> str:
    """Return a value as YAML of one line that keeps its type."""
    text = yaml.safe_dump(value, default_flow_style=True, width=math.inf, allow_unicode=True)
    return text.removesuffix('...\n').rstrip('\n')


def _normalize_array(value: Sequence[Any]) -> tuple[Any, ...]:
    """Return a tuple of values, of substitutions or of tuples of substitutions.

    Texts and substitutions mixed are one text, joined; for a list of texts with substitutions
    each is a list of its own. What is of several types is text, read as YAML when launching.
    """
    for item in value:
        ensure_argument_type(item, _ITEMS, 'item of a list')
    kinds = {next(kind for kind in _ITEMS if isinstance(item, kind)) for item in value}
    if kinds in ({int}, {bool}):
        return tuple(value)
    if kinds in ({float}, {int, float}):
        return tuple(map(float, value))
    if Substitution in kinds and kinds <= {str, Substitution}:
        return tuple(normalize_to_list_of_substitutions(value))
    return tuple(
        tuple(
            normalize_to_list_of_substitutions(
                as_yaml(item) if isinstance(item, _SCALARS) else item
            )
        )
        for item in value
    )


def _normalize_value(value: Any) -> Any:
    if isinstance(value, str):
        return (TextSubstitution(text=as_yaml(value)),)
    if isinstance(value, (bool, int, float, bytes, ParameterValue)):
        return value
    if isinstance(value, Substitution):
        return (value,)
    if isinstance(value, Sequence):
        return _normalize_array(value)
    raise TypeError(
        f'Unexpected type for parameter value {value!r}: allowed are bool, int, float, str, '
        'bytes, lists of one of them, substitutions and dictionaries'
    )


def normalize_parameter_dict(
    parameters: Mapping[Any, Any], *, _prefix: Sequence[Substitution] | None = None
) -> dict[_Subs, Any]:
    """Return parameters by name; those in inner dictionaries have names as ``outer.inner``.

    :raises TypeError: a value is none that a parameter can have.
    """
    if not isinstance(parameters, Mapping):
        raise TypeError(f'expected a dictionary of parameters, got {parameters!r}')
    normalized: dict[_Subs, Any] = {}
    for key, value in parameters.items():
        name = tuple(normalize_to_list_of_substitutions(key))
        if _prefix:
            name = (*_prefix, TextSubstitution(text='.'), *name)
        if isinstance(value, Mapping):
            normalized.update(normalize_parameter_dict(value, _prefix=name))
        else:
            normalized[name] = _normalize_value(value)
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
