# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Single numbers of a serialized message, without the message around them.

To make a Twist of its bytes takes ten times as long as to read two numbers out of them, and the
drivers of ten robots send a thousand a second.
"""

from collections.abc import Callable
from functools import reduce
from operator import attrgetter
import struct
from typing import Any

from rclpy.serialization import deserialize_message

from husky_sim.messages.cdr_stream import HEADER, Place
from husky_sim.messages.packed_message import PackedMessage

Numbers = tuple[float, ...]


def reader_of(kind: Any, *paths: str) -> Callable[[bytes], Numbers]:
    """
    Return a function that reads numbers out of a message, as a subscription with raw=True has it.

    What is not in the form in which this middleware writes them here is read by the middleware
    itself; it raises a RuntimeError where that is no such message.

    :param kind: of the messages; without texts and sequences, so that each number has one place.
    :param paths: to the numbers, with dots, in the order of the fields.
    """
    whole = PackedMessage(kind())
    places: list[Place] = [
        reduce(Place.__getitem__, path.split('.'), whole.places) for path in paths
    ]
    form, position = '<', 0
    for place in places:
        form += f'{place.begin - position}x{place.code}'
        position = place.begin + place.size
    layout = struct.Struct(f'{form}{len(bytes(whole)) - position}x')
    numbers_of = [attrgetter(path) for path in paths]

    def read(data: bytes) -> Numbers:
        if len(data) == layout.size and data[:2] == HEADER[:2]:
            return layout.unpack(data)
        if len(data) < len(HEADER):  # Cyclone DDS reads on behind the end
            raise RuntimeError(f'{len(data)} bytes are no message')
        message = deserialize_message(data, kind)
        return tuple(number_of(message) for number_of in numbers_of)

    return read
