# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Values of parameters when launching."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from launch.launch_context import LaunchContext
from launch.substitution import Substitution
from launch.utilities import ensure_argument_type, perform_substitutions
import yaml

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue

_SCALARS = (bool, int, float, str, bytes)
_AS_TEXT = (
    'If the parameter is meant to be a string, try wrapping it in '
    'launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)'
)


def _perform(
    context: LaunchContext, name: str, subs: tuple[Substitution, ...], *, empty: Any
) -> Any:
    """Return what YAML takes the text of the substitutions for."""
    text = perform_substitutions(context, subs)
    try:
        return yaml.safe_load(text) if text else empty
    except yaml.YAMLError:
        raise TypeError(
            f'Unable to parse the value of parameter {name} as yaml. {_AS_TEXT}'
        ) from None


def _check_list(name: str, values: list[Any]) -> tuple[Any, ...]:
    """Return the values where they are of one type that the items of a parameter can have."""
    kinds = {type(item) for item in values}
    if len(kinds) == 1 and kinds <= {bool, int, float, str}:
        return tuple(values)
    raise TypeError(
        'Expected a non-empty sequence of items of one type, which is bool, int, float or str, '
        f"for parameter '{name}', got {values}"
    )


def _evaluate(context: LaunchContext, name: str, value: Any) -> Any:
    if isinstance(value, ParameterValue):
        try:
            return value.evaluate(context)
        except ValueError as error:
            raise ValueError(f"parameter '{name}': {error}") from None
    if not isinstance(value, tuple):
        ensure_argument_type(value, _SCALARS, f"value of parameter '{name}'")
        return value
    if value and isinstance(value[0], Substitution):
        loaded = _perform(context, name, value, empty='')
        if isinstance(loaded, _SCALARS):
            return loaded
        if isinstance(loaded, list):
            return _check_list(name, loaded)
        raise TypeError(
            'Allowed value types are bool, int, float, str, bytes and lists of one of bool, int, '
            f"float, str. Got {loaded!r} of type {type(loaded).__name__} for parameter '{name}'. "
            f'{_AS_TEXT}'
        )
    return _check_list(
        name,
        [
            _perform(context, name, item, empty=None) if isinstance(item, tuple) else item
            for item in value
        ],
    )


def evaluate_parameter_dict(
    context: LaunchContext, parameters: Mapping[Any, Any]
) -> dict[str, Any]:
    """Return names and values of a normalized dictionary; lists become tuples.

    The text of substitutions is read as YAML, where no ParameterValue says otherwise.

    :raises TypeError: a value is none that a parameter can have.
    """
    evaluated = {}
    for key, value in parameters.items():
        ensure_argument_type(key, tuple, 'name of a normalized parameter')
        name = perform_substitutions(context, key)
        evaluated[name] = _evaluate(context, name, value)
    return evaluated


def evaluate_parameters(context: LaunchContext, parameters: Any) -> tuple[Any, ...]:
    """Return paths, parameters and dictionaries from normalized parameters."""
    output: list[Any] = []
    for item in parameters:
        if isinstance(item, ParameterFile):
            output.append(item.evaluate(context))
        elif isinstance(item, Mapping):
            output.append(evaluate_parameter_dict(context, item))
        else:
            ensure_argument_type(item, Parameter, 'normalized parameter')
            output.append(item)
    return tuple(output)
