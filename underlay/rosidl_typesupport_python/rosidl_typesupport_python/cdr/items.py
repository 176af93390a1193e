# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What is no row of numbers: text, sequences, and arrays of what is no number.

Each item writes a value behind the bytes that there are, and reads one from a position on.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
import struct
from typing import Any, Protocol

from rosidl_typesupport_python.cdr.row import Place, what_is_allowed

_LENGTH = struct.Struct('<I')
_UNKNOWN = ord('\N{REPLACEMENT CHARACTER}')


class Item(Protocol):
    def write(self, out: bytearray, value: Any) -> None: ...

    def read(self, data: bytes, position: int) -> tuple[Any, int]: ...


class Field:
    """The step of a codec that writes and reads one item."""

    def __init__(self, place: Place, item: Item) -> None:
        self._name = place.name
        self._get: Callable[[Any], Any] = attrgetter(place.dotted)
        self._node, self._slot = place.node, place.slot
        self._item = item

    def write(self, out: bytearray, message: Any) -> None:
        value = self._get(message)
        try:
            self._item.write(out, value)
        except TypeError as error:
            raise TypeError(f'{self._name}: {error}') from None
        except ValueError as error:  # or a UnicodeEncodeError, which takes more than a text
            raise ValueError(f'{self._name}: {error}') from None

    def read(self, data: bytes, position: int, nodes: list[Any]) -> int:
        value, position = self._item.read(data, position)
        setattr(nodes[self._node], self._slot, value)
        return position


@dataclass(frozen=True)
class Text:
    """
    A string.

    :param most: characters that are written; longer text is read, as by compiled types.
    """

    most: int | None

    def write(self, out: bytearray, value: Any) -> None:
        if not isinstance(value, str):
            raise TypeError(f'{value!r} is no str')
        check_length(len(value), self.most, 'characters')
        # a string of C ends at its first zero, as upstream's types have it
        text = value.encode().partition(b'\0')[0]
        write_length(out, len(text) + 1)
        out += text
        out += b'\0'

    def read(self, data: bytes, position: int) -> tuple[str, int]:
        length, position = read_length(data, position)
        end = position + length
        check_end(data, end)
        return data[position:end].partition(b'\0')[0].decode('utf-8', 'replace'), end


@dataclass(frozen=True)
class WideText:
    """
    A wstring.

    :param most: units that are written; longer text is read, as by compiled types.
    """

    most: int | None

    def write(self, out: bytearray, value: Any) -> None:
        if not isinstance(value, str):
            raise TypeError(f'{value!r} is no str')
        units = array('H', value.encode('utf-16-le'))
        check_length(len(units), self.most, 'characters')
        write_length(out, len(units))
        out += array('I', units).tobytes()

    def read(self, data: bytes, position: int) -> tuple[str, int]:
        length, position = read_length(data, position)
        end = position + 4 * length
        check_end(data, end)
        units = struct.unpack_from(f'<{length}I', data, position)
        known = array('H', (_UNKNOWN if unit > 0xFFFF else unit for unit in units))
        return known.tobytes().decode('utf-16-le', 'replace'), end


@dataclass(frozen=True)
class Numbers:
    """
    A sequence of numbers, an array.array in Python, or a list of bool or of bytes.

    :param size: of an array of bool or of bytes, which is a list too.
    """

    code: str
    size: int | None
    most: int | None

    def write(self, out: bytearray, value: Any) -> None:
        write_count(out, len(value), self.size, self.most)
        if len(value) == 0:
            return
        align(out, struct.calcsize(self.code))
        try:
            if self.code in '?c':
                out += struct.pack(f'{len(value)}{self.code}', *value)
            else:
                if not isinstance(value, array) or value.typecode != self.code:
                    value = array(self.code, value)
                out += value.tobytes()
        except (struct.error, TypeError, OverflowError):
            raise TypeError(f'an item is not {what_is_allowed(self.code)}') from None

    def read(self, data: bytes, position: int) -> tuple[Any, int]:
        count, position = read_count(data, position, self.size, self.most)
        size = struct.calcsize(self.code)
        if count:
            position += -position % size
        end = position + count * size
        check_end(data, end)
        if self.code in '?c':
            return list(struct.unpack(f'{count}{self.code}', data[position:end])), end
        numbers = array(self.code)
        numbers.frombytes(data[position:end])
        return numbers, end


@dataclass(frozen=True)
class Items:
    """A sequence or an array of text or of messages: a list in Python."""

    item: Item
    size: int | None
    most: int | None

    def write(self, out: bytearray, value: Any) -> None:
        write_count(out, len(value), self.size, self.most)
        write = self.item.write
        for item in value:
            write(out, item)

    def read(self, data: bytes, position: int) -> tuple[Any, int]:
        count, position = read_count(data, position, self.size, self.most)
        check_end(data, position + count)  # an item has a byte at least
        items = []
        for _ in range(count):
            item, position = self.item.read(data, position)
            items.append(item)
        return items, position


def align(out: bytearray, size: int) -> None:
    """Append zeros up to the next multiple of a size."""
    out += bytes(-len(out) % size)


def write_length(out: bytearray, length: int) -> None:
    align(out, 4)
    out += _LENGTH.pack(length)


def read_length(data: bytes, position: int) -> tuple[int, int]:
    """Return a length, and the position behind it."""
    position += -position % 4
    check_end(data, position + 4)
    return _LENGTH.unpack_from(data, position)[0], position + 4


def write_count(out: bytearray, count: int, size: int | None, most: int | None) -> None:
    """Write how many items follow, which an array of a size does not say."""
    if size is None:
        check_length(count, most, 'items')
        write_length(out, count)
    elif count != size:
        raise ValueError(f'{count} items; the array has {size}')


def read_count(data: bytes, position: int, size: int | None, most: int | None) -> tuple[int, int]:
    """Return how many items follow, and the position of the first."""
    if size is not None:
        return size, position
    count, position = read_length(data, position)
    check_length(count, most, 'items')
    return count, position


def check_length(length: int, most: int | None, what: str) -> None:
    if most is not None and length > most:
        raise ValueError(f'{length} {what}; at most {most} are allowed')


def check_end(data: bytes, end: int) -> None:
    if end > len(data):
        raise ValueError(f'the bytes end after {len(data)} of {end} or more')
