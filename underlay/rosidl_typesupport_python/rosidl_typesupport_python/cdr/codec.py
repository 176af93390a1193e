# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Writes and reads the messages of one type."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from itertools import groupby
import struct
import sys
from typing import Any, Protocol

from rosidl_parser import definition as idl

from rosidl_typesupport_python.cdr.items import (
    check_end,
    Field,
    Item,
    Items,
    Numbers,
    Text,
    WideText,
)
from rosidl_typesupport_python.cdr.row import CODES, Number, Place, Row


class Step(Protocol):
    """Some fields of a message that follow one another."""

    def write(self, out: bytearray, message: Any) -> None: ...

    def read(self, data: bytes, position: int, nodes: list[Any]) -> int: ...


class Codec:
    """
    The codec of a type of messages.

    Messages inside are written as if their fields were the outer message's own, so that
    numbers in a row are packed at once, whichever message they are of. `nodes` are the messages
    that a message consists of, outermost first.
    """

    def __init__(self, kind: Any) -> None:
        self._kind = kind
        self._nodes: list[tuple[Any, int, str, bool]] = []
        leaves = self._flatten(kind, (), 0)
        self._steps: list[Step] = []
        for numbers, group in groupby(leaves, lambda leaf: isinstance(leaf, Number)):
            if numbers:
                self._steps.append(Row([leaf for leaf in group if isinstance(leaf, Number)]))
            else:
                self._steps += [leaf for leaf in group if isinstance(leaf, Field)]

    def _flatten(self, kind: Any, path: tuple[str, ...], parent: int) -> list[Number | Field]:
        node = len(self._nodes)
        check_fields = sys.modules[kind.__module__].ros_python_check_fields == '1'
        self._nodes.append((kind, parent, path[-1] if path else '', check_fields))
        leaves: list[Number | Field] = []
        for name, slot in zip(kind.get_fields_and_field_types(), kind.SLOT_TYPES, strict=True):
            inner = (*path, f'_{name}')
            if isinstance(slot, idl.NamespacedType) and class_of(slot).SLOT_TYPES:
                leaves += self._flatten(class_of(slot), inner, node)
            else:
                leaves.append(_leaf(Place(inner, node), slot))
        return leaves

    def encode(self, message: Any) -> bytes:
        """
        Return the bytes of a message.

        :raises TypeError: if a field holds what is of another type.
        :raises ValueError: if one holds more than its type has room for.
        """
        out = bytearray()
        self.write(out, message)
        return bytes(out)

    def decode(self, data: bytes) -> Any:
        """
        Return the message that bytes stand for; what follows its last field is not read.

        :raises ValueError: if they are not the bytes of such a message.
        """
        try:
            return self.read(data, 0)[0]
        except (ValueError, struct.error) as error:
            raise ValueError(
                f'these are not the bytes of {type_name(self._kind)}: {error}; '
                'build the sender and this program from the same definition'
            ) from None

    def write(self, out: bytearray, message: Any) -> None:
        if not isinstance(message, self._kind):
            raise TypeError(f'{message!r} is no {type_name(self._kind)}')
        if not self._steps:
            out += b'\0'
        for step in self._steps:
            step.write(out, message)

    def read(self, data: bytes, position: int) -> tuple[Any, int]:
        nodes: list[Any] = []
        for kind, parent, slot, check_fields in self._nodes:
            node = kind.__new__(kind)  # __init__ would make what is read anyway
            node._check_fields = check_fields
            if slot:
                setattr(nodes[parent], slot, node)
            nodes.append(node)
        for step in self._steps:
            position = step.read(data, position, nodes)
        if not self._steps:
            position += 1
            check_end(data, position)
        return nodes[0], position


codec_of = cache(Codec)


def type_name(kind: Any) -> str:
    """Return the name of a type as ROS writes it: std_msgs/msg/String."""
    return '/'.join([*kind.__module__.split('.')[:2], kind.__name__])


def class_of(slot: Any) -> Any:
    """
    Return the class of a type.

    That of a part of a service or an action, as Fibonacci_Goal, is in the module of the whole.
    """
    whole = getattr(import_module('.'.join(slot.namespaces)), slot.name.partition('_')[0])
    return getattr(sys.modules[whole.__module__], slot.name)


def _leaf(place: Place, slot: Any) -> Number | Field:
    if isinstance(slot, idl.BasicType):
        return Number(place, _code_of(slot))
    if isinstance(slot, idl.Array) and isinstance(slot.value_type, idl.BasicType):
        code = _code_of(slot.value_type)
        if code not in '?c':
            return Number(place, code, slot.size)
    return Field(place, _item_of(slot))


def _item_of(slot: Any) -> Item:
    most = getattr(slot, 'maximum_size', None)
    if isinstance(slot, idl.AbstractNestedType):
        size = slot.size if isinstance(slot, idl.Array) else None
        if isinstance(slot.value_type, idl.BasicType):
            return Numbers(_code_of(slot.value_type), size, most)
        return Items(_item_of(slot.value_type), size, most)
    if isinstance(slot, idl.NamespacedType):
        return codec_of(class_of(slot))
    if isinstance(slot, idl.AbstractWString):
        return WideText(most)
    return Text(most)


def _code_of(slot: Any) -> str:
    try:
        return CODES[slot.typename]
    except KeyError:
        raise TypeError(f'{slot.typename} is no type of ROS: use {", ".join(CODES)}') from None
