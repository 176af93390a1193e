# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Fill messages from what a person wrote: dictionaries, lists and scalars, as YAML gives them."""

from __future__ import annotations

import array
from collections.abc import Callable, Iterable, Mapping
import contextlib
from dataclasses import dataclass, field
from functools import partial
import math
import struct
from typing import Any

from rosidl_parser import definition

from rosidl_runtime_py.convert import get_message_slot_types
from rosidl_runtime_py.import_message import import_message_from_namespaced_type
from rosidl_runtime_py.numpy_values import is_numpy

_HEADER = (('std_msgs', 'msg'), 'Header')
_TIME = (('builtin_interfaces', 'msg'), 'Time')
_TRUTHS = {'true': True, 'yes': True, 'on': True, 'false': False, 'no': False, 'off': False}
_FLOAT32_END = 3.402823466e38
"""Where the check that rosidl generates ends: below the largest float32, by rounding."""


def set_message_fields(
    msg: Any,
    values: Mapping[str, Any],
    expand_header_auto: bool = False,
    expand_time_now: bool = False,
) -> list[Callable[..., None]]:
    """Set the fields of a message.

    A value that does not fit its field is refused before it reaches the middleware, which
    checks nothing: the type, the range of a number, the length of an array.

    :param values: values by field, nested as the message is.
    :param expand_header_auto: 'auto' for a std_msgs/Header asks for the time of publishing.
    :param expand_time_now: 'now' for a builtin_interfaces/Time asks for the time of publishing.
    :return: functions that take a Time and set it in each place that asked for it, a header
        too.
    :raises AttributeError: the message has no such field.
    :raises TypeError: a value has another type than its field.
    :raises ValueError: a value is out of the range of its field, or text that is no number.
    """
    filler = _Filler(expand_header_auto, expand_time_now)
    filler.fill(msg, values, '')
    return filler.setters


def _as_meant(name: object, value: object, slots: Iterable[str]) -> str:
    """Say how YAML wants `data:hello` and `{x: 0,5}`, in which it finds a name without a value."""
    if isinstance(name, bool):  # as turtlesim's SetPen has a field off
        words = ('on', 'yes') if name else ('off', 'no')
        meant = next((word for word in words if word in slots), None)
        return f"; YAML takes {meant} for {name}: put it in quotes, '{meant}'" if meant else ''
    if isinstance(name, int) and value is None:
        return '; decimals have a point, as in 0.5'
    field_name, colon, text = str(name).partition(':')
    if not colon or not text or field_name not in slots:
        return ''
    return f"; write '{field_name}: {text}', with a blank behind the colon"


@dataclass
class _Filler:
    """Converts values to what the fields of messages hold, at any depth."""

    expand_header_auto: bool
    expand_time_now: bool
    setters: list[Callable[..., None]] = field(default_factory=list)

    def fill(self, message: Any, given: Any, path: str) -> None:
        if not isinstance(given, Mapping):
            raise TypeError(
                f"Value '{given}' is expected to be a dictionary but is a {type(given).__name__}"
            )
        slots = get_message_slot_types(message)
        for name, value in given.items():
            if name not in slots:
                raise AttributeError(
                    f"'{type(message).__name__}' object has no attribute '{name}'; its fields "
                    f'are {", ".join(slots) or "none"}{_as_meant(name, value, slots)}'
                )
            if not self._asks_for_the_time(message, name, value, slots[name]):
                field_path = f'{path}.{name}' if path else str(name)
                setattr(message, name, self._convert(value, slots[name], field_path))

    def _asks_for_the_time(self, message: Any, name: str, value: Any, kind: Any) -> bool:
        if not isinstance(kind, definition.NamespacedType):
            return False
        named = (tuple(kind.namespaces), kind.name)
        if self.expand_header_auto and named == _HEADER and value == 'auto':
            self.setters.append(partial(setattr, getattr(message, name), 'stamp'))
            return True
        if self.expand_time_now and named == _TIME and value == 'now':
            self.setters.append(partial(setattr, message, name))
            return True
        return False

    def _convert(self, value: Any, kind: Any, path: str) -> Any:
        if isinstance(kind, definition.AbstractNestedType):
            items = [
                self._convert(item, kind.value_type, f'{path}[{i}]')
                for i, item in enumerate(_items(value, kind, path))
            ]
            return _sequence(items, kind)
        if isinstance(kind, definition.NamespacedType):
            message_class = import_message_from_namespaced_type(kind)
            if isinstance(value, message_class):
                return value
            message = message_class()
            self.fill(message, value, path)
            return message
        if isinstance(kind, definition.AbstractGenericString):
            return _string(value, kind, path)
        return _scalar(value, kind.typename, path)


def _items(value: Any, kind: Any, path: str) -> list[Any]:
    known = isinstance(value, (list, tuple, array.array, bytes, bytearray))
    if not known and not is_numpy(value, 'ndarray'):
        raise TypeError(f"{path}: '{value}' is a {type(value).__name__}, expected a list")
    if isinstance(kind, definition.Array) and len(value) != kind.size:
        raise ValueError(f'{path}: {len(value)} elements, expected exactly {kind.size}')
    if isinstance(kind, definition.BoundedSequence) and len(value) > kind.maximum_size:
        raise ValueError(f'{path}: {len(value)} elements, allowed are {kind.maximum_size}')
    if getattr(kind.value_type, 'typename', '') == 'octet' and isinstance(
        value, (bytes, bytearray)
    ):
        return [bytes((item,)) for item in value]
    return list(value)


_ARRAY_CODES = {
    'float': ('f', 'float32'), 'double': ('d', 'float64'),
    'int8': ('b', 'int8'), 'uint8': ('B', 'uint8'),
    'int16': ('h', 'int16'), 'uint16': ('H', 'uint16'),
    'int32': ('i', 'int32'), 'uint32': ('I', 'uint32'),
    'int64': ('q', 'int64'), 'uint64': ('Q', 'uint64'),
}  # fmt: skip


def _sequence(items: list[Any], kind: Any) -> Any:
    codes = _ARRAY_CODES.get(getattr(kind.value_type, 'typename', ''))
    if codes is None:
        return items
    if isinstance(kind, definition.Array):
        import numpy  # loaded only now: see numpy_values

        return numpy.array(items, dtype=codes[1])
    return array.array(codes[0], items)


def _string(value: Any, kind: Any, path: str) -> str:
    if isinstance(value, (list, tuple, Mapping)):
        raise TypeError(f"{path}: '{value}' is a {type(value).__name__}, expected a string")
    # YAML reads an unquoted 5, true or nothing as a number, a truth value, None.
    text = value if isinstance(value, str) else '' if value is None else str(value)
    if '\0' in text:
        raise ValueError(f'{path}: a string cannot hold the character NUL')
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ValueError(f'{path}: {text!r} cannot be encoded in UTF-8') from None
    if kind.has_maximum_size() and len(text) > kind.maximum_size:
        raise ValueError(f'{path}: {len(text)} characters, allowed are {kind.maximum_size}')
    return text


def _scalar(value: Any, typename: str, path: str) -> Any:
    if typename == 'boolean':
        if isinstance(value, str):  # in quotes, so that YAML has not read it
            value = _TRUTHS.get(value.lower(), value)
        if isinstance(value, bool) or is_numpy(value, 'bool_') or value in (0, 1):
            return bool(value)
        raise TypeError(f"{path}: '{value}' is refused, expected true or false")
    if typename in ('float', 'double', 'long double'):
        return _float(value, typename, path)
    if typename == 'octet':
        if isinstance(value, (list, tuple)) and len(value) == 1:
            value = value[0]  # upstream takes a byte as [5], and 5 for the one that is 0
        if isinstance(value, (bytes, str)) and len(value) == 1 and ord(value) < 256:
            return bytes((ord(value),))
        return bytes((_integer(value, 'uint8', path),))
    if typename in ('char', 'wchar'):
        return _integer(value, 'uint8' if typename == 'char' else 'uint16', path)
    return _integer(value, typename, path)


def _refusal(value: Any) -> type[Exception]:
    """Return what to raise for a value that is no number."""
    return ValueError if isinstance(value, str) else TypeError


def _float(value: Any, typename: str, path: str) -> float:
    try:
        # YAML 1.1 reads 1e3 as text; a person means a number.
        number = float(value) if not isinstance(value, bool) else None
    except (TypeError, ValueError, OverflowError):
        number = None
    if number is None:
        raise _refusal(value)(f"{path}: '{value}' is refused, expected a number")
    if typename == 'float' and math.isfinite(number):
        try:
            sent: float = struct.unpack('<f', struct.pack('<f', number))[0]
        except OverflowError:
            raise ValueError(f'{path}: {number} does not fit a float32') from None
        if abs(sent) > _FLOAT32_END:
            raise ValueError(
                f'{path}: {number} is refused: a node that checks fields fails on a float32 '
                f'beyond {_FLOAT32_END}'
            )
    return number


def _integer(value: Any, typename: str, path: str) -> int:
    if (isinstance(value, float) or is_numpy(value, 'floating')) and float(value).is_integer():
        value = int(value)
    if isinstance(value, str):
        with contextlib.suppress(ValueError):
            value = int(value, 0)
    if isinstance(value, bool) or not (isinstance(value, int) or is_numpy(value, 'integer')):
        raise _refusal(value)(f"{path}: '{value}' is refused, expected a whole number")
    bits = int(typename.removeprefix('u').removeprefix('int'))
    low, high = (
        (0, 2**bits - 1) if typename[0] == 'u' else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    )
    if not low <= value <= high:
        raise ValueError(f'{path}: {value} does not fit {typename} ({low} to {high})')
    return int(value)
