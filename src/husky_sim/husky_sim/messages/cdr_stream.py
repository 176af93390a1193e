# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The bytes of plain CDR, written and read from front to back; the rules stand in `cdr`."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
import struct

HEADER = b'\x00\x01\x00\x00'
TEXT = 's'

_PADDING = b'\x00'


@dataclass(frozen=True)
class Place:
    """
    Where a field stands in the bytes of one message.

    :param begin: the first byte, the header counted.
    :param code: of numbers, as in the module struct; TEXT; empty where there are parts.
    :param count: of numbers, or of the bytes of a text with its length.
    :param parts: of a message by their names, of a row of texts or messages by their index.
    """

    begin: int
    code: str = ''
    count: int = 0
    parts: Mapping[str | int, 'Place'] = field(default_factory=dict)

    @property
    def size(self) -> int:
        """Return how many bytes its numbers, or its text, take."""
        return struct.calcsize(f'<{self.count}{self.code}')

    def __getitem__(self, name: str | int) -> 'Place':
        """Return the place of a part."""
        if name not in self.parts:
            raise KeyError(f'{name!r}: the parts are {", ".join(map(str, self.parts)) or "none"}')
        return self.parts[name]

    def leaves(self, name: str = '') -> Iterator[tuple[str, 'Place']]:
        """Yield what has no parts, in order, and its name; a message without fields has none."""
        if self.code:
            yield name, self
        for key, part in self.parts.items():
            yield from part.leaves(f'{name}.{key}' if name else str(key))


class Writer:
    def __init__(self) -> None:
        self.data = bytearray(HEADER)

    def add(self, alignment: int, data: bytes) -> int:
        """Append bytes, and return where they begin."""
        self.data += _PADDING * ((len(HEADER) - len(self.data)) % alignment)
        begin = len(self.data)
        self.data += data
        return begin

    def add_length(self, length: int) -> int:
        return self.add(4, struct.pack('<I', length))


class Reader:
    def __init__(self, data: bytes) -> None:
        self._data = data
        self._position = len(HEADER)

    def take(self, alignment: int, size: int) -> bytes:
        """Return the next bytes."""
        begin = self._position + (len(HEADER) - self._position) % alignment
        self._position = begin + size
        if self._position > len(self._data):
            raise ValueError(f'ends after {len(self._data)} bytes of {self._position} or more')
        return self._data[begin : self._position]

    def take_length(self) -> int:
        return int.from_bytes(self.take(4, 4), 'little')
