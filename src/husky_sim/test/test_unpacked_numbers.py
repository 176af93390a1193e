# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers are read out of bytes as the middleware reads them, and what it refuses is refused."""

import math
import struct

from geometry_msgs.msg import Twist
from husky_sim.messages.unpacked_numbers import reader_of
from hypothesis import example, given
from hypothesis import strategies as st
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosgraph_msgs.msg import Clock

READ = reader_of(Twist, 'linear.x', 'angular.z')
NUMBERS = st.lists(st.floats(), min_size=6, max_size=6)


def twist_of(values: list[float]) -> Twist:
    message = Twist()
    message.linear.x, message.linear.y, message.linear.z = values[:3]
    message.angular.x, message.angular.y, message.angular.z = values[3:]
    return message


def same(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    return struct.pack(f'{len(one)}d', *one) == struct.pack(f'{len(other)}d', *other)


@given(values=NUMBERS)
def test_they_are_those_that_the_middleware_reads(values: list[float]) -> None:
    data = bytes(serialize_message(twist_of(values)))
    message = deserialize_message(data, Twist)
    assert same(READ(data), (message.linear.x, message.angular.z))
    assert same(READ(data), (values[0], values[5]))


@given(values=NUMBERS)
def test_of_another_byte_order_too(values: list[float]) -> None:
    data = b'\0\0\0\0' + struct.pack('>6d', *values)
    assert [*map(repr, READ(data))] == [repr(values[0]), repr(values[5])]


@pytest.mark.parametrize('count', range(4))
def test_less_than_a_header_is_refused(count: int) -> None:
    with pytest.raises(RuntimeError):
        READ(bytes(count))


HEADERS = st.sampled_from([b'\0\0\0\0', b'\0\1\0\0', b'\0\1\0\3'])


@given(header=HEADERS | st.binary(min_size=4, max_size=4), body=st.binary(max_size=60))
@example(header=b'\0\0\0\0', body=bytes(range(48)))
@example(header=b'\0\1\0\0', body=bytes(range(48)))
@example(header=b'\0\1\0\0', body=bytes(range(49)))
@example(header=b'\0\1\0\0', body=bytes(range(47)))
def test_what_the_middleware_refuses_is_refused(header: bytes, body: bytes) -> None:
    data = header + body
    try:
        message = deserialize_message(data, Twist)
    except RuntimeError:
        with pytest.raises(RuntimeError):
            READ(data)
    else:
        assert same(READ(data), (message.linear.x, message.angular.z))


def test_whole_numbers_of_another_message() -> None:
    message = Clock()
    message.clock.sec, message.clock.nanosec = 3, 7
    data = bytes(serialize_message(message))
    assert reader_of(Clock, 'clock.sec', 'clock.nanosec')(data) == (3, 7)
    assert reader_of(Clock, 'clock.nanosec')(data) == (7,)
    assert math.isnan(READ(bytes(serialize_message(twist_of([math.nan] * 6))))[0])
