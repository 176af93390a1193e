# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The serialized form of messages: plain CDR, encoding version 1, little endian.

Where a field stands follows from the message's type and from the lengths of its strings and
sequences, and from nothing else. The rules (OMG DDS-XTypes 1.3, 7.4.1 and 7.6.3.1):

* The bytes begin with 00 01 00 00. Alignment counts from behind these four.
* A number of n bytes stands at the next multiple of n. The bytes left out before it are zeros.
* A string is its size in bytes as uint32, UTF-8, and a zero, which is counted.
* A wstring is its length as uint32, then a uint32 for each unit of UTF-16 (ROS's own rule).
* A sequence is its length as uint32, then its items. An array is its items alone.
* A message is its fields in their order. Without fields it is one byte (ROS's own rule).
"""

from array import array
from dataclasses import dataclass
from functools import cache
from importlib import import_module
import struct
from typing import Any, Protocol

import numpy as np
from rosidl_parser import definition as idl

from husky_sim.messages.cdr_stream import HEADER, Place, Reader, TEXT, Writer

# The kinds of numbers, as the modules struct and array call them.
_CODES = {
    **{'boolean': '?', 'octet': 'c', 'float': 'f', 'double': 'd'},
    **{'int8': 'b', 'int16': 'h', 'int32': 'i', 'int64': 'q'},
    **{'uint8': 'B', 'uint16': 'H', 'uint32': 'I', 'uint64': 'Q'},
}
_NAMES = {code: name for name, code in _CODES.items()}


def encode(message: Any) -> bytes:
    """
    Return the bytes of a message.

    :raises ValueError: if a field holds what its type cannot.
    """
    return bytes(encode_with_places(message)[0])


def encode_with_places(message: Any) -> tuple[bytearray, Place]:
    """
    Return the bytes of a message, and where each of its fields stands in them.

    :raises ValueError: if a field holds what its type cannot.
    """
    writer = Writer()
    kind: Any = type(message)
    place = _codec_of_message(kind).write(writer, message)
    return writer.data, place


def decode(kind: Any, data: bytes | bytearray | memoryview) -> Any:
    """
    Return the message that bytes stand for; what follows its last field is not read.

    :raises ValueError: if they are not the bytes of such a message.
    """
    head = bytes(data[:4])
    if head[:2] != HEADER[:2]:
        raise ValueError(
            f'{kind.__name__}: begins with {head.hex(" ") or "nothing"}; '
            f'only {HEADER.hex(" ")} is read (plain CDR, little endian)'
        )
    try:
        return _codec_of_message(kind).read(Reader(bytes(data)))
    except ValueError as error:
        raise ValueError(f'{kind.__name__}: {error}') from None


class _Codec(Protocol):
    def write(self, writer: Writer, value: Any) -> Place: ...

    def read(self, reader: Reader) -> Any: ...


@dataclass(frozen=True)
class _Number:
    code: str

    def write(self, writer: Writer, value: Any) -> Place:
        data = _pack(self.code, 1, [value])
        return Place(writer.add(len(data), data), self.code, 1)

    def read(self, reader: Reader) -> Any:
        size = struct.calcsize(f'<{self.code}')
        return _unpack(self.code, reader.take(size, size))[0]


@dataclass(frozen=True)
class _Text:
    most: int | None

    def write(self, writer: Writer, value: Any) -> Place:
        if not isinstance(value, str) or '\0' in value:
            raise ValueError(f'{value!r} is no text without NUL')
        _check_length(len(value), self.most, 'characters')
        data = value.encode() + b'\0'
        begin = writer.add_length(len(data))
        writer.add(1, data)
        return Place(begin, TEXT, 4 + len(data))

    def read(self, reader: Reader) -> str:
        data = reader.take(1, reader.take_length())
        text = data[:-1].decode()  # UnicodeDecodeError is a ValueError
        if data[-1:] not in (b'', b'\0') or '\0' in text:
            raise ValueError(f'{data!r} is no text with one NUL, at its end')
        _check_length(len(text), self.most, 'characters')
        return text


@dataclass(frozen=True)
class _WideText:
    most: int | None

    def write(self, writer: Writer, value: Any) -> Place:
        if not isinstance(value, str):
            raise ValueError(f'{value!r} is no text')
        _check_length(len(value), self.most, 'characters')
        units = np.frombuffer(value.encode('utf-16-le'), '<H').astype('<I')
        begin = writer.add_length(len(units))
        writer.add(1, units.tobytes())
        return Place(begin, TEXT, 4 + 4 * len(units))

    def read(self, reader: Reader) -> str:
        units = np.frombuffer(reader.take(4, 4 * reader.take_length()), '<I')
        if (units > 0xFFFF).any():
            raise ValueError(f'{units.max():#x} is no unit of UTF-16')
        text = units.astype('<H').tobytes().decode('utf-16-le')
        _check_length(len(text), self.most, 'characters')
        return text


@dataclass(frozen=True)
class _Row:
    """Items one after the other: an array of a fixed size, or a sequence of at most so many."""

    item: _Codec
    size: int | None
    most: int | None

    def write(self, writer: Writer, value: Any) -> Place:
        begin = self._write_length(writer, len(value))
        return Place(begin, parts={i: self.item.write(writer, v) for i, v in enumerate(value)})

    def read(self, reader: Reader) -> Any:
        return [self.item.read(reader) for _ in range(self._read_length(reader))]

    def _write_length(self, writer: Writer, length: int) -> int:
        if self.size is None:
            _check_length(length, self.most, 'items')
            return writer.add_length(length)
        if length != self.size:
            raise ValueError(f'{length} items; the array has {self.size}')
        return len(writer.data)

    def _read_length(self, reader: Reader) -> int:
        if self.size is not None:
            return self.size
        length = reader.take_length()
        _check_length(length, self.most, 'items')
        return length


@dataclass(frozen=True)
class _NumberRow(_Row):
    item: _Number

    def write(self, writer: Writer, value: Any) -> Place:
        code, length = self.item.code, len(value)
        self._write_length(writer, length)
        alignment = struct.calcsize(f'<{code}') if length else 1
        begin = writer.add(alignment, _pack(code, length, value))
        return Place(begin, code, length)

    def read(self, reader: Reader) -> Any:
        code, length = self.item.code, self._read_length(reader)
        size = struct.calcsize(f'<{code}')
        data = reader.take(size if length else 1, size * length)
        if code in '?c':
            return list(_unpack(code, data))
        numbers = np.frombuffer(data, f'<{code}').astype(code)
        return array(code, numbers.tobytes()) if self.size is None else numbers


@dataclass(frozen=True)
class _Message:
    kind: Any
    fields: tuple[tuple[str, _Codec], ...]

    def write(self, writer: Writer, value: Any) -> Place:
        if not isinstance(value, self.kind):
            raise ValueError(f'{value!r} is no {self.kind.__name__}')
        begin = len(writer.data) if self.fields else writer.add(1, b'\0')
        parts: dict[str | int, Place] = {}
        for name, codec in self.fields:
            try:
                parts[name] = codec.write(writer, getattr(value, name))
            except (ValueError, TypeError) as error:  # TypeError: what has no length
                raise ValueError(f'{name}: {error}') from None
        return Place(begin, parts=parts)

    def read(self, reader: Reader) -> Any:
        if not self.fields:
            reader.take(1, 1)
        values = {}
        for name, codec in self.fields:
            try:
                values[name] = codec.read(reader)
            except ValueError as error:
                raise ValueError(f'{name}: {error}') from None
        return self.kind(**values)


def _pack(code: str, count: int, values: Any) -> bytes:
    try:
        if count == 1 or code in '?c':
            return struct.pack(f'<{count}{code}', *values)
        if isinstance(values, bytes | bytearray) and code != 'B':
            values = list(values)  # array() would take them for its memory
        numbers = array('d' if code == 'f' else code, values)  # refuses what is of another kind
        with np.errstate(over='raise'):
            return np.asarray(numbers).astype(f'<{code}').tobytes()
    except (struct.error, TypeError, ArithmeticError):
        what = repr(values[0]) if count == 1 else f'a row of {count}'
        raise ValueError(f'{what} is not of {_NAMES[code]}') from None


def _unpack(code: str, data: bytes) -> tuple[Any, ...]:
    if code == '?' and data.strip(b'\0\1'):
        raise ValueError(f'{data.hex(" ")} is neither true (01) nor false (00)')
    return struct.unpack(f'<{len(data) // struct.calcsize(f"<{code}")}{code}', data)


def _check_length(length: int, most: int | None, what: str) -> None:
    if most is not None and length > most:
        raise ValueError(f'{length} {what}; at most {most} are allowed')


@cache
def _codec_of_message(kind: Any) -> _Message:
    if not hasattr(kind, 'SLOT_TYPES'):
        raise TypeError(f'{kind.__name__} is no type of a message')
    fields = zip(kind.get_fields_and_field_types(), kind.SLOT_TYPES, strict=True)
    return _Message(kind, tuple((name, _codec_of(slot)) for name, slot in fields))


def _codec_of(slot: Any) -> _Codec:
    """Return what writes and reads the fields of an IDL type."""
    most = getattr(slot, 'maximum_size', None)
    if isinstance(slot, idl.AbstractNestedType):
        item = _codec_of(slot.value_type)
        size = slot.size if isinstance(slot, idl.Array) else None
        if isinstance(item, _Number):
            return _NumberRow(item, size, most)
        return _Row(item, size, most)
    if isinstance(slot, idl.NamespacedType):
        # A part of a service or of an action, as Fibonacci_Goal, is in the module of the whole.
        whole = getattr(import_module('.'.join(slot.namespaces)), slot.name.partition('_')[0])
        return _codec_of_message(getattr(import_module(whole.__module__), slot.name))
    if isinstance(slot, idl.AbstractString):
        return _Text(most)
    if isinstance(slot, idl.AbstractWString):
        return _WideText(most)
    if slot.typename in _CODES:
        return _Number(_CODES[slot.typename])
    raise TypeError(f'{slot.typename}: no .msg file can ask for it; use {", ".join(_CODES)}')
