# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Values of parameters when launching."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from launch.launch_context import LaunchContext
from launch.substitution import Substitution
from launch.utilities import perform_substitutions
import yaml

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue

_SCALARS = (bool, int, float, str, bytes)
_ALLOWED = (
    'Allowed value types are bytes, bool, int, float, str, and non-empty lists of one of bool, '
    'int, float, str'
)


def _perform(context: LaunchContext, name: str, subs: tuple[Substitution, ...]) -> Any:
    text = perform_substitutions(context, subs)
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError:
        raise ValueError(
            f'Unable to parse the value of parameter {name} as yaml. If the parameter is meant to '
            'be a string, try wrapping it in '
            'launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)'
        ) from None


def _check(name: str, value: Any) -> Any:
    """Return the value where a parameter can have it."""
    if isinstance(value, _SCALARS):
        return value
    if isinstance(value, Sequence):
        kinds = {type(item) for item in value}
        if kinds == {int, float}:
            return [float(item) for item in value]
        if len(kinds) == 1 and kinds <= {bool, int, float, str}:
            return list(value)
    said = 'nothing' if value is None else repr(value)
    raise TypeError(f"parameter '{name}' has the value {said}. {_ALLOWED}.")


def _evaluate(context: LaunchContext, name: str, value: Any) -> Any:
    if isinstance(value, ParameterValue):
        return _check(name, value.evaluate(context))
    if isinstance(value, tuple):
        return _check(name, _perform(context, name, value))
    if isinstance(value, list):
        items = [
            _perform(context, name, item) if isinstance(item, tuple) else item for item in value
        ]
        return _check(name, items)
    return _check(name, value)


def evaluate_parameter_dict(
    context: LaunchContext, parameters: Mapping[Any, Any]
) -> dict[str, Any]:
    """Return names and values of a normalized dictionary.

    The text of substitutions is read as YAML, where no ParameterValue says otherwise.
    """
    evaluated = {}
    for key, value in parameters.items():
        name = perform_substitutions(context, key)
        evaluated[name] = _evaluate(context, name, value)
    return evaluated


def evaluate_parameters(context: LaunchContext, parameters: Any) -> tuple[Any, ...]:
    """Return paths, parameters and dictionaries from normalized parameters."""
    output: list[Any] = []
    for item in parameters:
        if isinstance(item, ParameterFile):
            output.append(item.evaluate(context))
        elif isinstance(item, Parameter):
            item.evaluate(context)
            output.append(item)
        elif isinstance(item, Mapping):
            output.append(evaluate_parameter_dict(context, item))
        else:
            raise TypeError(f'{item!r} is not normalized')
    return tuple(output)
