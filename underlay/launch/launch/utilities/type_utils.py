# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Values of a wanted type from text and substitutions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, get_args, get_origin, TYPE_CHECKING

import yaml

from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from .argument_types import ensure_argument_type
from .normalizing import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..launch_context import LaunchContext

ScalarTypesTuple = (int, float, bool, str)
ListTypesTuple = (list[int], list[float], list[bool], list[str])
AllowedTypesTuple = (*ScalarTypesTuple, *ListTypesTuple)
ScalarTypesType = type[int | float | bool | str]
ListTypesType = type[list[int] | list[float] | list[bool] | list[str]]
AllowedTypesType = Any
ScalarValueType = int | float | bool | str
ListValueType = list[int] | list[float] | list[bool] | list[str]
SequenceValueType = Sequence[int] | Sequence[float] | Sequence[bool] | Sequence[str]
AllowedValueType = ScalarValueType | SequenceValueType
SomeScalarType = SomeSubstitutionsType | ScalarValueType
SomeSequenceType = Sequence[SomeScalarType]
SomeValueType = Any
NormalizedScalarType = list[Substitution] | ScalarValueType
NormalizedSequenceType = list[NormalizedScalarType]
NormalizedValueType = Any
StrSomeScalarType = SomeScalarType
StrSomeSequenceType = Sequence[ScalarValueType]
StrSomeValueType = Any


def is_typing_list(data_type: Any) -> bool:
    """Return whether a type is ``List`` or a list of something, as ``list[int]``."""
    return get_origin(data_type) is list


def is_valid_scalar_type(data_type: Any) -> bool:
    return data_type in ScalarTypesTuple


def extract_type(data_type: Any) -> tuple[type, bool]:
    """Return the scalar type, and whether a list of it is meant.

    :raises ValueError: it is neither a scalar type nor a list of one.
    """
    if is_valid_scalar_type(data_type):
        return data_type, False
    arguments = get_args(data_type)
    if is_typing_list(data_type) and arguments and is_valid_scalar_type(arguments[0]):
        return arguments[0], True
    raise ValueError(f'Unrecognized data type: {data_type}')


def is_instance_of_valid_type(value: Any, *, can_be_str: bool = False) -> bool:
    """Return whether a value is a scalar or a list of scalars of one type.

    :param can_be_str: a list may hold text among the others.
    """
    if not isinstance(value, list):
        return isinstance(value, ScalarTypesTuple)
    kind = next((type(item) for item in value if not isinstance(item, str)), str)
    allowed = (kind, str) if can_be_str else kind
    return is_valid_scalar_type(kind) and all(isinstance(item, allowed) for item in value)


def is_instance_of(value: Any, data_type: Any = None, *, can_be_str: bool = False) -> bool:
    """Return whether a value is of a type, of any that is allowed where it is None.

    :param can_be_str: text will do too.
    :raises ValueError: there is no such type.
    """
    if data_type is None:
        return is_instance_of_valid_type(value, can_be_str=can_be_str)
    scalar, is_list = extract_type(data_type)
    allowed = (str, scalar) if can_be_str else (scalar,)
    if is_list:
        return isinstance(value, list) and all(isinstance(item, allowed) for item in value)
    return isinstance(value, allowed)


def coerce_to_type(value: str, data_type: Any = None, *, can_be_str: bool = False) -> Any:
    """Return what a text means as a type; without a type, what YAML takes it for.

    :param can_be_str: keep a text, also in a list, that does not mean the type.
    :raises ValueError: it does not mean that type, or there is no such type.
    :raises TypeError: it is no text.
    """
    ensure_argument_type(value, str, 'value', 'coerce_to_type')
    scalar, is_list = (None, False) if data_type is None else extract_type(data_type)
    if scalar in (int, float, str) and not is_list:
        try:
            return scalar(value)
        except ValueError:
            if can_be_str:
                return value
            raise
    text = {'1': 'true', '0': 'false'}.get(value, value) if data_type is bool else value
    loaded = _load_yaml(text, data_type, can_be_str)
    if not is_instance_of(loaded, data_type, can_be_str=can_be_str):
        raise _meaningless(value, data_type)
    return loaded


def _load_yaml(text: str, data_type: Any, can_be_str: bool) -> Any:
    if not text:
        return text  # nothing, to YAML
    try:
        return yaml.safe_load(text)
    except Exception as error:  # also ValueError, as of a date that does not exist
        if can_be_str:
            return text
        raise _meaningless(text, data_type, f': {error}') from None


def _meaningless(text: str, data_type: Any, why: str = '') -> ValueError:
    if data_type is None:
        allowed = 'int, float, bool, str or a list of one of them'
        return ValueError(f"Failed to convert '{text}' using yaml rules to {allowed}{why}")
    scalar, is_list = extract_type(data_type)
    kind = f'list of {scalar.__name__}' if is_list else scalar.__name__
    return ValueError(f"Cannot convert value '{text}' to {kind}{why}")


def coerce_list(value: list[str], data_type: Any = None, *, can_be_str: bool = False) -> list[Any]:
    """Return what each text of a list means, all of one type; see :func:`coerce_to_type`."""
    ensure_argument_type(value, list, 'value', 'coerce_list')
    output = [coerce_to_type(item, data_type, can_be_str=can_be_str) for item in value]
    if not is_instance_of_valid_type(output, can_be_str=can_be_str):
        raise ValueError(f'cannot convert {value} to a list of one type: it means {output}')
    return output


def get_typed_value(value: str | list[str], data_type: Any, *, can_be_str: bool = False) -> Any:
    """Return a text, or a list of texts, as the type; see :func:`coerce_to_type`.

    :raises TypeError: it is a list, and the type is none of a list.
    """
    if not isinstance(value, list):
        return coerce_to_type(value, data_type, can_be_str=can_be_str)
    scalar = None
    if data_type is not None:
        scalar, is_list = extract_type(data_type)
        if not is_list:
            raise TypeError(f"Cannot convert input '{value}' of type '{type(value)}' to {scalar}")
    return coerce_list(value, scalar, can_be_str=can_be_str)


def is_substitution(x: Any) -> bool:
    """Return whether a value is a substitution, or texts and substitutions to be joined."""
    if isinstance(x, Substitution):
        return True
    return (
        isinstance(x, (list, tuple))
        and all(isinstance(item, (Substitution, str)) for item in x)
        and any(isinstance(item, Substitution) for item in x)
    )


def is_normalized_substitution(x: Any) -> bool:
    return isinstance(x, list) and bool(x) and all(isinstance(item, Substitution) for item in x)


def normalize_typed_substitution(value: Any, data_type: Any) -> Any:
    """Return a form of a mix of values and substitutions that can be performed later.

    In a list of numbers with and without a point all become float.

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
    items = list(value)
    kind = _kind_of_items([item for item in items if not is_substitution(item)], value)
    if data_type is not None:
        scalar, is_list = extract_type(data_type)
        if not is_list or kind not in (None, scalar):
            raise TypeError(f"value='{value}' is a list of {kind}, expected {data_type}")
    return [
        normalize_to_list_of_substitutions(item)
        if is_substitution(item)
        else float(item)
        if kind is float
        else item
        for item in items
    ]


def _kind_of_items(scalars: list[Any], value: Any) -> type | None:
    """Return the one type of scalars, None where there are none."""
    kinds = {type(item) for item in scalars}
    if kinds == {int, float}:
        return float
    if len(kinds) > 1 or not all(map(is_valid_scalar_type, kinds)):
        raise TypeError(f"the items of value='{value}' are not scalars of one type")
    return kinds.pop() if kinds else None


def perform_typed_substitution(context: LaunchContext, value: Any, data_type: Any | None) -> Any:
    """Return the value of a normalized mix as the type.

    :raises ValueError: the text of a substitution does not mean the type, a list has items of
        several, or there is no such type.
    :raises TypeError: the value is neither a substitution nor of the type.
    """
    if is_normalized_substitution(value):
        return coerce_to_type(perform_substitutions(context, value), data_type)
    if not isinstance(value, list):
        if not isinstance(value, ScalarTypesTuple) or not is_instance_of(value, data_type):
            raise TypeError(f"value='{value}' is not an instance of {data_type}")
        return value
    scalar, is_list = (None, True) if data_type is None else extract_type(data_type)
    output = [
        coerce_to_type(perform_substitutions(context, item), scalar)
        if is_normalized_substitution(item)
        else item
        for item in value
    ]
    if not is_list or not is_instance_of(output, data_type):
        raise ValueError(f'the items of {output} are not of one type, or not of {data_type}')
    return output
