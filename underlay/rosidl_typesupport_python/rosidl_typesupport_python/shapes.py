# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where the fields of a type end, as native.c is told: struct shape."""

from __future__ import annotations

from functools import cache
import struct
from typing import Any

from rosidl_parser import definition as idl

from rosidl_typesupport_python.cdr import class_of
from rosidl_typesupport_python.cdr.row import CODES
from rosidl_typesupport_python.memory import keep
from rosidl_typesupport_python.native import Shape

_WIDE_UNIT = 4
_UNBOUNDED = 2**32
_END = Shape()


@cache
def shape_of(kind: Any) -> int:
    """Return the address of the shape of a class of messages."""
    # without fields it is one byte
    return _keep([_field(slot) for slot in kind.SLOT_TYPES] or [Shape(1, False, 1)])


def _field(slot: Any) -> Shape:
    if isinstance(slot, idl.AbstractNestedType):
        item = _field(slot.value_type)
        if item.has_length:  # a text
            item = Shape(1, False, 1, _keep([item]))
        if isinstance(slot, idl.Array):
            return Shape(item.size, False, slot.size, item.items)
        return Shape(item.size, True, getattr(slot, 'maximum_size', _UNBOUNDED), item.items)
    if isinstance(slot, idl.NamespacedType):
        return Shape(1, False, 1, shape_of(class_of(slot)))
    if isinstance(slot, idl.BasicType):
        return Shape(struct.calcsize(f'<{CODES[slot.typename]}'), False, 1)
    return Shape(_WIDE_UNIT if isinstance(slot, idl.AbstractWString) else 1, True, _UNBOUNDED)


def _keep(fields: list[Shape]) -> int:
    return keep((Shape * (len(fields) + 1))(*fields, _END))
