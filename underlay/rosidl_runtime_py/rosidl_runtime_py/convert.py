# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Show messages: as YAML, as one line of comma-separated values, as ordered dictionaries."""

from __future__ import annotations

import array
from collections import OrderedDict
from collections.abc import Iterable
import sys
from typing import Any

from rosidl_parser import definition
import yaml

from rosidl_runtime_py.numpy_values import is_numpy


class _Dumper(yaml.SafeDumper):
    """Writes ordered dictionaries as plain mappings and knows no anchors."""

    def ignore_aliases(self, _: Any) -> bool:
        return True


_Dumper.add_representer(
    OrderedDict,
    lambda dumper, data: dumper.represent_mapping(
        'tag:yaml.org,2002:map', data.items(), flow_style=False
    ),
)
_Dumper.add_representer(
    tuple, lambda dumper, data: dumper.represent_sequence('tag:yaml.org,2002:seq', data)
)


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Convert a message to YAML.

    :param truncate_length: longer arrays, bytes and strings are cut here and end with '...'.
    :param no_arr: tell of arrays only type and length.
    :param no_str: tell of strings only the length.
    :param flow_style: arrays are written in one line, in brackets.
    """
    values = message_to_ordereddict(
        msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str
    )
    return yaml.dump(
        values,
        Dumper=_Dumper,
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=flow_style,
        sort_keys=False,
    )


def message_to_csv(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> str:
    """Convert a message to its values, separated by commas; parameters as message_to_yaml."""

    def text(value: Any, field_type: Any = None) -> str:
        if _is_sequence(value):
            if no_arr and field_type is not None:
                return _abbreviated(value, field_type)
            shown = value if truncate_length is None else value[:truncate_length]
            parts = [text(item) for item in shown]
            return _joined(parts + ['...'] * (len(shown) < len(value)))
        if isinstance(value, str) and no_str:
            return f'<string length: <{len(value)}>>'
        if isinstance(value, (bytes, str)):
            return str(_cut(value, truncate_length))
        if isinstance(value, (bool, float, int)) or is_numpy(value, 'number'):
            return str(value)
        return message_to_csv(value, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)

    return _joined(
        text(getattr(msg, name), field_type)
        for name, field_type in get_message_slot_types(msg).items()
    )


def _joined(parts: Iterable[str]) -> str:
    """Join texts by commas; as upstream, none stands before the first that is not empty."""
    joined = ''
    for part in parts:
        joined += f',{part}' if joined else part
    return joined


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Convert a message to nested dictionaries; parameters as message_to_yaml."""
    return OrderedDict(
        (
            name,
            _convert_value(
                getattr(msg, name),
                field_type=field_type,
                truncate_length=truncate_length,
                no_arr=no_arr,
                no_str=no_str,
            ),
        )
        for name, field_type in get_message_slot_types(msg).items()
    )


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """Map the fields of a message to their types (of rosidl_parser.definition)."""
    return OrderedDict(zip(msg.get_fields_and_field_types(), msg.SLOT_TYPES, strict=True))


def _convert_value(
    value: Any,
    *,
    field_type: Any = None,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> Any:
    """Return plain Python values for what a field holds; parameters as message_to_yaml."""

    def convert(item: Any) -> Any:
        return _convert_value(item, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)

    if isinstance(value, bytes):
        return ''.join(map(chr, value[:truncate_length])) + _dots(value, truncate_length)
    if isinstance(value, str):
        return f'<string length: <{len(value)}>>' if no_str else _cut(value, truncate_length)
    if _is_sequence(value):
        if no_arr and field_type is not None:
            return _abbreviated(value, field_type)
        items = [convert(item) for item in value[:truncate_length]]
        items += ['...'] * bool(_dots(value, truncate_length))
        return tuple(items) if isinstance(value, tuple) else items
    if isinstance(value, dict):
        return type(value)((key, convert(item)) for key, item in value.items())
    if is_numpy(value, 'generic'):
        return value.item()
    if isinstance(value, (bool, float, int)):
        return value
    return message_to_ordereddict(
        value, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str
    )


def _is_sequence(value: Any) -> bool:
    return isinstance(value, (list, tuple, array.array)) or is_numpy(value, 'ndarray')


def _dots(value: Any, truncate_length: int | None) -> str:
    return '...' if truncate_length is not None and len(value) > truncate_length else ''


def _cut(value: Any, truncate_length: int | None) -> Any:
    if not _dots(value, truncate_length):
        return value
    return value[:truncate_length] + (b'...' if isinstance(value, bytes) else '...')


def _abbreviated(value: Any, field_type: Any) -> str:
    item = _type_name(field_type.value_type)
    if isinstance(field_type, definition.Array):
        return f'<array type: {item}[{field_type.size}]>'
    if isinstance(field_type, definition.BoundedSequence):
        item = f'{item}[{field_type.maximum_size}]'
    return f'<sequence type: {item}, length: {len(value)}>'


def _type_name(value_type: Any) -> str:
    if isinstance(value_type, definition.BasicType):
        return str(value_type.typename)
    if isinstance(value_type, definition.AbstractString):
        return 'string'
    if isinstance(value_type, definition.AbstractWString):
        return 'wstring'
    if isinstance(value_type, definition.NamespacedType):
        return '/'.join(value_type.namespaced_name())
    return str(getattr(value_type, 'name', 'unknown'))
