# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Types of attributes."""

from __future__ import annotations

from typing import Any, get_args, get_origin

from .entity import Entity

_IDENTIFIERS: dict[str, Any] = {
    'int': int,
    'float': float,
    'bool': bool,
    'str': str,
    'list_of_int': list[int],
    'list_of_float': list[float],
    'list_of_bool': list[bool],
    'list_of_str': list[str],
    'yaml': None,
}


def check_is_list_entity(data_type: Any) -> bool:
    """Return whether elements are asked for, not a value."""
    return get_origin(data_type) is list and any(
        isinstance(kind, type) and issubclass(kind, Entity) for kind in get_args(data_type)
    )


def get_data_type_from_identifier(type_identifier: str) -> Any:
    """Return the type of a name as 'int' or 'list_of_str'.

    :raises ValueError: there is no such name.
    """
    if type_identifier not in _IDENTIFIERS:
        raise ValueError(
            f"unknown type '{type_identifier}': allowed are {', '.join(_IDENTIFIERS)}"
        )
    return _IDENTIFIERS[type_identifier]
