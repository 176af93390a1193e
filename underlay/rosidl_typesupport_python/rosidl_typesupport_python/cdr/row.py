# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that follow one another, packed and unpacked in one call."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter
import struct
from typing import Any

# The kinds of numbers, as the modules struct and array call them.
CODES = {
    **{'boolean': '?', 'octet': 'c', 'float': 'f', 'double': 'd'},
    **{'int8': 'b', 'int16': 'h', 'int32': 'i', 'int64': 'q'},
    **{'uint8': 'B', 'uint16': 'H', 'uint32': 'I', 'uint64': 'Q'},
}
_NAMES = {code: name for name, code in CODES.items()}
# numpy has two kinds of 64 bits; an array of the other one is printed with its dtype.
_OF_NUMPY = {'q': 'int64', 'Q': 'uint64'}


@dataclass(frozen=True)
class Place:
    """
    Where a field of a message is.

    :param path: from the outermost message to the field, by names of slots.
    :param node: which of the messages inside that one holds it, see codec.
    """

    path: tuple[str, ...]
    node: int

    @property
    def slot(self) -> str:
        return self.path[-1]

    @property
    def name(self) -> str:
        """Return the field's name as a user writes it: pose.position.x."""
        return '.'.join(slot[1:] for slot in self.path)

    @property
    def dotted(self) -> str:
        return '.'.join(self.path)


@dataclass(frozen=True)
class Number:
    """A number, or an array of so many of them, which is a numpy array in Python."""

    place: Place
    code: str
    count: int | None = None

    @property
    def size(self) -> int:
        return struct.calcsize(f'<{self.code}')

    @property
    def form(self) -> str:
        return self.code if self.count is None else f'{self.count * self.size}s'

    def check(self, value: Any) -> None:
        """Refuse what cannot be packed, by name."""
        try:
            if self.count is None:
                struct.pack(self.code, value)
            else:
                self.array_bytes(value)
        except (struct.error, TypeError, OverflowError):
            raise TypeError(
                f'{self.place.name} = {value!r}: not {what_is_allowed(self.code)}'
            ) from None

    def array_bytes(self, value: Any) -> bytes:
        """Return the bytes of an array."""
        import numpy as np  # as long to load as a node without arrays is

        data = np.ascontiguousarray(value, f'<{self.code}').tobytes()
        if self.count is None or len(data) != self.count * self.size:
            raise ValueError(f'{self.place.name}: {len(value)} items, not {self.count}')
        return data

    def array(self, data: bytes) -> Any:
        """Return the array that bytes stand for, which can be written to."""
        import numpy as np

        kind = _OF_NUMPY.get(self.code, self.code)
        return np.frombuffer(data, f'<{self.code}').astype(kind)


class Row:
    """
    The step of a codec that writes and reads numbers.

    :param numbers: in their order.
    """

    def __init__(self, numbers: Sequence[Number]) -> None:
        self._numbers = tuple(numbers)
        get = attrgetter(*(number.place.dotted for number in numbers))
        self._get = get if len(numbers) > 1 else lambda message: (get(message),)
        self._arrays = tuple((i, n) for i, n in enumerate(numbers) if n.count is not None)
        self._targets = tuple((n.place.node, n.place.slot) for n in numbers)
        # where padding goes depends on where the row begins, modulo 8
        self._forms = tuple(struct.Struct(self._form(begin)) for begin in range(8))

    def _form(self, begin: int) -> str:
        form, position = '<', begin
        for number in self._numbers:
            padding = -position % number.size
            form += f'{padding}x{number.form}'
            position += padding + number.size * (1 if number.count is None else number.count)
        return form

    def write(self, out: bytearray, message: Any) -> None:
        values = list(self._get(message))
        try:
            for i, number in self._arrays:
                values[i] = number.array_bytes(values[i])
            out += self._forms[len(out) & 7].pack(*values)
        except (struct.error, TypeError, OverflowError):
            for number, value in zip(self._numbers, self._get(message), strict=True):
                number.check(value)
            raise

    def read(self, data: bytes, position: int, nodes: list[Any]) -> int:
        form = self._forms[position & 7]
        values = list(form.unpack_from(data, position))
        for i, number in self._arrays:
            values[i] = number.array(values[i])
        for (node, slot), value in zip(self._targets, values):  # noqa: B905 of one length
            setattr(nodes[node], slot, value)
        return position + form.size


def what_is_allowed(code: str) -> str:
    """Say which values a kind of number has."""
    if code == 'c':
        return 'an octet: bytes of length 1'
    if code in 'fd?':
        return f'a {_NAMES[code]}'
    bits = 8 * struct.calcsize(f'<{code}')
    low, high = (0, 2**bits - 1) if code.isupper() else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return f'an integer from {low} to {high}'
