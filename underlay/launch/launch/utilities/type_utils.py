# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Values of a wanted type from text and substitutions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, get_args, get_origin, TYPE_CHECKING

import yaml

from ..substitution import Substitution
from .normalizing import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..launch_context import LaunchContext

ScalarTypesTuple = (int, float, bool, str)
ListTypesTuple = (list[int], list[float], list[bool], list[str])
AllowedTypesTuple = (*ScalarTypesTuple, *ListTypesTuple)
AllowedTypesType = Any
ScalarValueType = int | float | bool | str
AllowedValueType = ScalarValueType | list[Any]
SomeValueType = Any
NormalizedValueType = Any
StrSomeValueType = Any


def extract_type(data_type: Any) -> tuple[type, bool]:
    """Return the scalar type, and whether a list of it is meant.

    :raises ValueError: it is neither a scalar type nor a list of one.
    """
    if data_type in ScalarTypesTuple:
        return data_type, False
    arguments = get_args(data_type)
    if get_origin(data_type) is list and arguments and arguments[0] in ScalarTypesTuple:
        return arguments[0], True
    raise ValueError(f'Unrecognized data type: {data_type}')


def is_instance_of_valid_type(value: Any, can_be_str: bool = False) -> bool:
    """Return whether a value is a scalar or a list of scalars of one type.

    :param can_be_str: a list may hold text among the others.
    """
    if not isinstance(value, list):
        return isinstance(value, ScalarTypesTuple)
    kinds = {type(item) for item in value}
    if can_be_str and len(kinds) == 2:
        kinds.discard(str)
    return not kinds or (len(kinds) == 1 and kinds.pop() in ScalarTypesTuple)


def is_instance_of(value: Any, data_type: Any = None, can_be_str: bool = False) -> bool:
    if data_type is None:
        return is_instance_of_valid_type(value, can_be_str)
    scalar, is_list = extract_type(data_type)
    allowed = (str, scalar) if can_be_str else (scalar,)
    if is_list:
        return isinstance(value, list) and all(isinstance(item, allowed) for item in value)
    return isinstance(value, allowed)


def _load_yaml(value: str, what: str) -> Any:
    try:
        loaded = yaml.safe_load(value)
    except yaml.YAMLError as error:
        raise ValueError(f'{what}: yaml.safe_load() failed\n{error}') from None
    # Empty text is a string to whoever writes it, and nothing to YAML.
    return '' if loaded is None and value.strip() == '' else loaded


def coerce_to_type(value: str, data_type: Any = None, can_be_str: bool = False) -> Any:
    """Return what a text means as a type; without a type, what YAML takes it for.

    :param can_be_str: keep the text where it does not mean the type.
    :raises ValueError: it does not mean that type.
    """
    if not isinstance(value, str):
        raise TypeError(f"'value' is {value!r}, expected text")
    try:
        return _coerce(value, data_type, can_be_str)
    except ValueError:
        if can_be_str and (data_type is None or not extract_type(data_type)[1]):
            return value
        raise


def _coerce(value: str, data_type: Any, can_be_str: bool) -> Any:
    if data_type is None:
        loaded = _load_yaml(value, f"Failed to convert '{value}' using yaml rules")
        if not is_instance_of_valid_type(loaded, can_be_str):
            raise ValueError(
                f"Failed to convert '{value}' using yaml rules: output type is not allowed, got "
                f'{type(loaded)}'
            )
        return loaded
    scalar, is_list = extract_type(data_type)
    if is_list:
        loaded = _load_yaml(value, f"Cannot convert value '{value}' to a list of '{scalar}'")
        if not is_instance_of(loaded, data_type, can_be_str):
            raise ValueError(f"Cannot convert value '{value}' to a list of '{scalar}'")
        return loaded
    if scalar is bool:
        return _coerce_bool(value)
    return scalar(value)


def _coerce_bool(value: str) -> bool:
    known = {'1': True, '0': False}
    loaded = known.get(value.strip(), _load_yaml(value, f"Failed to convert '{value}' to 'bool'"))
    if not isinstance(loaded, bool):
        raise ValueError(f"Cannot convert value '{value}' to '{bool}'")
    return loaded


def coerce_list(value: list[str], data_type: Any = None, can_be_str: bool = False) -> list[Any]:
    output = [coerce_to_type(item, data_type, can_be_str) for item in value]
    if not is_instance_of_valid_type(output, can_be_str):
        raise ValueError(f'cannot convert value to {data_type}. Got value=`{value}`')
    return output


def get_typed_value(value: str | list[str], data_type: Any, can_be_str: bool = False) -> Any:
    """Return a text, or a list of texts, as the type."""
    if not isinstance(value, list):
        return coerce_to_type(value, data_type, can_be_str)
    scalar = None
    if data_type is not None:
        scalar, is_list = extract_type(data_type)
        if not is_list:
            raise TypeError(f"Cannot convert input '{value}' of type '{type(value)}' to {scalar}")
    return coerce_list(value, scalar, can_be_str)


def is_substitution(value: Any) -> bool:
    """Return whether a value is a substitution, or texts and substitutions to be joined."""
    if isinstance(value, Substitution):
        return True
    return (
        isinstance(value, (list, tuple))
        and all(isinstance(item, (Substitution, str)) for item in value)
        and any(isinstance(item, Substitution) for item in value)
    )


def is_normalized_substitution(value: Any) -> bool:
    return (
        isinstance(value, list)
        and bool(value)
        and all(isinstance(item, Substitution) for item in value)
    )


def normalize_typed_substitution(value: Any, data_type: Any) -> Any:
    """Return a form of a mix of values and substitutions that can be performed later.

    :raises TypeError: it can never become the type.
    """
    if isinstance(value, ScalarTypesTuple):
        if not is_instance_of(value, data_type):
            raise TypeError(f"value='{value}' is not an instance of {data_type}")
        return value
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    if not isinstance(value, Iterable):
        raise TypeError(
            'value should be either a scalar, a substitution, or a mixed list of scalars and '
            f'substitutions. Got `value={value}` of type `{type(value)}`.'
        )
    scalar = None if data_type is None else extract_type(data_type)[0]
    return [normalize_typed_substitution(item, scalar) for item in value]


def perform_typed_substitution(context: LaunchContext, value: Any, data_type: Any | None) -> Any:
    """Return the value of a normalized mix as the type.

    :raises ValueError: the text of a substitution does not mean the type.
    """
    if is_normalized_substitution(value):
        return coerce_to_type(perform_substitutions(context, value), data_type)
    if isinstance(value, list):
        scalar = None if data_type is None else extract_type(data_type)[0]
        output = [perform_typed_substitution(context, item, scalar) for item in value]
        if not is_instance_of_valid_type(output):
            raise ValueError(f'the items of {output} are not of one type')
        return output
    if not is_instance_of(value, data_type):
        raise ValueError(f"value='{value}' is not an instance of {data_type}")
    return value
