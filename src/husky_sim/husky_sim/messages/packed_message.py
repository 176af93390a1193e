# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Messages whose lengths never change, kept in their serialized form.

To convert a message from Python takes longer than to simulate its values. In the messages of a
control period only numbers change, and each keeps its place. So a message is encoded once;
afterwards numbers are packed into their places, and the bytes are published.

`proven_form` checks that the middleware reads these bytes as they were packed.
"""

from collections.abc import Callable, Iterable
from functools import partial
from itertools import count
import struct
from typing import Any

import numpy as np
import numpy.typing as npt
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.utilities import get_rmw_implementation_identifier

from husky_sim.messages.cdr import decode, encode_with_places
from husky_sim.messages.cdr_stream import HEADER, Place, TEXT

Form = Callable[['PackedMessage'], Any]
"""Makes of a packed message what `Publisher.publish` takes."""


class PackedMessage:
    """
    The bytes of one message, `packed`, and the places of its fields.

    :param message: with everything that never changes, and every sequence at its length.
    """

    def __init__(self, message: Any) -> None:
        self.kind = type(message)
        self.packed, self.places = encode_with_places(message)

    def __bytes__(self) -> bytes:
        """Return the serialized message."""
        return bytes(self.packed)

    def unpacked(self) -> Any:
        """Return an ordinary message that says the same."""
        return decode(self.kind, self.packed)

    def fields(self) -> list[tuple[str, bytes]]:
        """Return every number, row of numbers and text: its name and its bytes."""
        return [
            (name, bytes(self.packed[place.begin : place.begin + place.size]))
            for name, place in self.places.leaves()
        ]

    def packer(self, *places: Place) -> Callable[..., None]:
        """
        Return a function that packs all numbers of a field, or of several that follow another.

        :raises ValueError: if a field holds text.
        """
        leaves = [leaf for place in places for _, leaf in place.leaves()]
        form, begin = '<', leaves[0].begin
        position = begin
        for leaf in leaves:
            if leaf.code == TEXT:
                raise ValueError('only numbers can be packed; this field holds text')
            form += f'{leaf.begin - position}x{leaf.count}{leaf.code}'
            position = leaf.begin + leaf.size
        return partial(struct.Struct(form).pack_into, self.packed, begin)

    def array(self, place: Place) -> npt.NDArray[Any]:
        """Return the numbers of a field of many as an array; what is written to it is packed."""
        return np.frombuffer(self.packed, f'<{place.code}', place.count, place.begin)

    def numbers(self, place: Place) -> 'memoryview[float]':
        """Return the numbers of a field as `array` does; single ones are packed sooner so."""
        packed = memoryview(self.packed)[place.begin : place.begin + place.size]
        return packed.cast(place.code)  # type: ignore[call-overload]


def proven_form(messages: Iterable[PackedMessage], logger: Any) -> Form:
    """
    Return the form in which to publish messages of these layouts.

    That is their bytes, if the middleware reads in them what was packed. Otherwise all are
    published as ordinary messages, which takes longer, and one line of the log says so.
    """
    for message in messages:
        try:
            prove(message)
        except ValueError as error:
            logger.warning(
                f'{get_rmw_implementation_identifier()} has another form for {error}; '
                'publishing ordinary messages, which takes longer'
            )
            return PackedMessage.unpacked
    return bytes


def prove(message: PackedMessage) -> None:
    """
    Pack distinct numbers into a copy of a message, let the middleware read it, and compare.

    :raises ValueError: if its form is another one, or a field is not read as it was packed.
    """
    kind = f'{message.kind.__module__.partition(".")[0]}/{message.kind.__name__}'
    copy = PackedMessage(message.unpacked())
    numbers = count(1)
    for _, place in copy.places.leaves():
        if place.code != TEXT:
            copy.packer(place)(*(_like(place.code, next(numbers)) for _ in range(place.count)))
    try:
        head = bytes(serialize_message(message.unpacked()))[:2]
        if head != HEADER[:2]:
            raise ValueError(f'{kind}: it begins with {head.hex(" ")}, not {HEADER[:2].hex(" ")}')
        read = PackedMessage(deserialize_message(bytes(copy), message.kind))
    except RuntimeError as error:  # rclpy's RMWError
        raise ValueError(f'{kind}: {error}') from error
    if bytes(read) != bytes(copy):
        pairs = zip(copy.fields(), read.fields(), strict=False)
        name = next((one[0] for one, other in pairs if one != other), 'a length')
        raise ValueError(f'{kind}: {name} is not read as it was packed')


def _like(code: str, number: int) -> Any:
    """Return a number of a kind: another for each, as far as the kind has so many."""
    if code == 'c':
        return bytes([number % 256])
    if code in 'fd':
        return number + 0.5
    return number % {'?': 2, 'b': 128, 'B': 256}.get(code, 1 << 15)
