# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages whose every field is drawn at random, of any type that has SLOT_TYPES."""

from __future__ import annotations

from importlib import import_module
from random import Random
import struct
import sys
from typing import Any

from rosidl_parser import definition as idl

_INTEGERS = {
    f'{sign}int{bits}': (0, 2**bits - 1) if sign else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    for sign in ('', 'u')
    for bits in (8, 16, 32, 64)
}
_LETTERS = 'abc XYZ\n"\\äß€中\u200b'
_BEYOND_16_BITS = '😀🚗'


def random_message(kind: Any, random: Random) -> Any:
    """Return a message of a class, its sequences up to four items long or as long as allowed."""
    fields = zip(kind.get_fields_and_field_types(), kind.SLOT_TYPES, strict=True)
    return kind(**{name: _value(slot, random) for name, slot in fields})


def _value(slot: Any, random: Random) -> Any:
    most = getattr(slot, 'maximum_size', None)
    if isinstance(slot, idl.AbstractNestedType):
        count = slot.size if isinstance(slot, idl.Array) else random.randint(0, most or 4)
        return [_value(slot.value_type, random) for _ in range(count)]
    if isinstance(slot, idl.NamespacedType):
        return random_message(class_of(slot), random)
    if isinstance(slot, idl.AbstractGenericString):
        # a bound of a wstring counts units of 16 bits, of which these letters have two each
        letters = _LETTERS + (_BEYOND_16_BITS if most is None else '')
        return ''.join(random.choices(letters, k=random.randint(0, most or 12)))
    return _number(slot.typename, random)


def _number(name: str, random: Random) -> Any:
    if name == 'boolean':
        return random.random() < 0.5
    if name == 'octet':
        return bytes([random.randrange(256)])
    if name in _INTEGERS:
        low, high = _INTEGERS[name]
        return random.choice((low, high, random.randint(low, high)))
    number = random.choice((0.0, -0.0, float('inf'), random.uniform(-1e9, 1e9)))
    return struct.unpack('f', struct.pack('f', number))[0] if name == 'float' else number


def class_of(slot: Any) -> Any:
    """Return the class of a type; that of Fibonacci_Goal is in the module of Fibonacci."""
    whole = getattr(import_module('.'.join(slot.namespaces)), slot.name.partition('_')[0])
    return getattr(sys.modules[whole.__module__], slot.name)
