# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Messages of a fixed size, kept in their serialized form.

To convert a message from Python costs more than to simulate what it says. In the messages of a
control period only numbers change, and in the serialized form (plain CDR, OMG DDS-XTypes 7.4.1)
each of them stays at its place. So a message is serialized once; afterwards numbers are packed
into their places, and the bytes are published.
"""

from collections.abc import Callable
from copy import deepcopy
from functools import partial, reduce
from string import digits
import struct
from typing import Any

import numpy as np
import numpy.typing as npt
from rclpy.serialization import serialize_message


class SerializedMessage:
    """
    The bytes of one message.

    :param message: with everything that never changes, and every sequence at its length.
    """

    def __init__(self, message: Any) -> None:
        self._message = message
        self._bytes = bytearray(serialize_message(message))

    def __bytes__(self) -> bytes:
        """Return what `Publisher.publish` takes."""
        return bytes(self._bytes)

    def packer(self, numbers: str, path: str) -> Callable[..., None]:
        """
        Return a function that packs numbers into their places.

        :param numbers: how many of which kind, as in the module struct: '7d', 'iI'.
        :param path: the field of the first one, as in 'pose.pose.position.x' or 'covariance.0';
            the others follow it.
        """
        places = struct.Struct(f'={numbers}')
        return partial(places.pack_into, self._bytes, self._place_of(path, numbers.lstrip(digits)))

    def doubles(self, path: str, count: int) -> npt.NDArray[np.float64]:
        """Return the numbers of an array field as an array; what is written to it is packed."""
        return np.frombuffer(self._bytes, np.float64, count, self._place_of(f'{path}.0', 'd'))

    def _place_of(self, path: str, kinds: str) -> int:
        """Return where the bytes of two messages differ that differ in one number alone."""
        mark = struct.Struct(f'={kinds[0]}')
        forms = [self._with(path, *mark.unpack(byte * mark.size)) for byte in (b'\x11', b'\x22')]
        pairs = enumerate(zip(*forms, strict=True))
        return next(place for place, (one, other) in pairs if one != other)

    def _with(self, path: str, number: float) -> bytes:
        message = deepcopy(self._message)
        *parents, name = path.split('.')
        owner = reduce(getattr, parents, message)
        if name.isdecimal():
            owner[int(name)] = number
        else:
            setattr(owner, name, number)
        return bytes(serialize_message(message))
