# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The layouts of the messages: correct for any content of memory, and checked at the start."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import count
import os
import subprocess
import sys
from typing import Any
from unittest import mock

from geometry_msgs.msg import Point, Twist
from husky_sim.messages import packed_message
from husky_sim.messages.cdr import decode, encode
from husky_sim.messages.layouts import packed_messages
from husky_sim.messages.packed_message import PackedMessage, prove, proven_form
from nav_msgs.msg import Odometry
import numpy as np
import pytest
import rclpy.serialization
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import NavSatFix

PROCESSES = 6  # 200 of them: benchmark/fresh_packing.py
PROGRAM = """
from hashlib import sha256
from husky_sim.messages.layouts import packed_messages
from husky_sim.messages.packed_message import prove

for message in packed_messages():
    prove(message)
print(sha256(b''.join(map(bytes, packed_messages()))).hexdigest())
"""


class Log(list[str]):
    warning = list.append


def distinct(message: PackedMessage) -> PackedMessage:
    """Pack distinct numbers into every place of a message."""
    numbers = count(1)
    for _, place in message.places.leaves():
        if place.code != 's':
            message.packer(place)(*(next(numbers) for _ in range(place.count)))
    return message


@pytest.mark.parametrize('make', [type(each) for each in packed_messages()])
def test_padding_of_any_byte_changes_nothing(make: Callable[[], PackedMessage]) -> None:
    plain = distinct(make())
    expected = plain.unpacked()
    for byte in range(256):
        with mock.patch('husky_sim.messages.cdr_stream._PADDING', bytes([byte])):
            filled = distinct(make())
            foreign = encode(expected)
        # Within what is packed at once, the padding is packed too.
        assert filled.fields() == plain.fields()
        for data in (bytes(filled), foreign):
            assert deserialize_message(data, plain.kind) == expected
            assert decode(plain.kind, data) == expected


@pytest.mark.parametrize('make', [type(each) for each in packed_messages()])
def test_what_the_memory_held_gets_into_no_message(
    make: Callable[[], PackedMessage], monkeypatch: pytest.MonkeyPatch
) -> None:
    serialize, turn = rclpy.serialization._rclpy.rclpy_serialize, count()

    def filled(message: Any, kind: Any) -> bytes:
        """Serialize as over memory that held another byte each time."""
        data, form = bytearray(serialize(message, kind)), encode(message)
        with mock.patch('husky_sim.messages.cdr_stream._PADDING', b'\xff'):
            marked = encode(message)
        padding = [place for place, byte in enumerate(form) if byte != marked[place]]
        for place in [*padding, *range(len(form), len(data))]:
            data[place] = next(turn) % 256
        return bytes(data)

    monkeypatch.setattr('rclpy.serialization._rclpy.rclpy_serialize', filled)
    first = bytes(distinct(make()))
    for _ in range(256):
        message = make()
        prove(message)
        assert bytes(distinct(message)) == first
    assert deserialize_message(first, message.kind) == message.unpacked()


def pack_in_a_fresh_process(byte: int) -> subprocess.CompletedProcess[str]:
    # glibc fills memory with the byte's complement before it hands it out.
    environment = {**os.environ, 'MALLOC_PERTURB_': str(byte)}
    command = [sys.executable, '-c', PROGRAM]
    return subprocess.run(command, env=environment, capture_output=True, text=True)


def test_fresh_processes_all_pack_the_same() -> None:
    with ThreadPoolExecutor(2) as pool:
        ran = list(pool.map(pack_in_a_fresh_process, range(1, 256, 255 // PROCESSES)))
    assert [(done.returncode, done.stderr) for done in ran] == [(0, '')] * len(ran)
    assert len(ran) >= PROCESSES
    assert len({done.stdout for done in ran}) == 1


def test_equal_messages_have_equal_bytes() -> None:
    for one, other in zip(packed_messages(), packed_messages(), strict=True):
        assert bytes(one) == bytes(other) == encode(one.unpacked())


def test_a_field_is_packed_and_nothing_beside_it() -> None:
    message = PackedMessage(Odometry(child_frame_id='base_link'))
    message.packer(message.places['pose']['pose']['orientation'])(1.0, 2.0, 3.0, 4.0)
    message.array(message.places['twist']['covariance'])[35] = 5.0
    expected = Odometry(child_frame_id='base_link')
    turn: Any = expected.pose.pose.orientation
    turn.x, turn.y, turn.z, turn.w = 1.0, 2.0, 3.0, 4.0
    expected.twist.covariance = np.array([0.0] * 35 + [5.0])
    assert message.unpacked() == deserialize_message(bytes(message), Odometry) == expected


def test_several_fields_are_packed_over_the_padding_between() -> None:
    message = PackedMessage(NavSatFix())
    places = message.places
    message.packer(places['status'], places['latitude'])(-1, 3, 49.5)
    received = deserialize_message(bytes(message), NavSatFix)
    assert (received.status.status, received.status.service, received.latitude) == (-1, 3, 49.5)
    with pytest.raises(ValueError, match='only numbers can be packed; this field holds text'):
        message.packer(places['header'])


def test_with_this_middleware_bytes_are_published() -> None:
    log = Log()
    assert proven_form(packed_messages(), log) is bytes
    assert log == []


def refuse(*_: object) -> None:
    raise RuntimeError('failed to deserialize')


def swap(data: bytes, kind: Any) -> Any:
    message = deserialize_message(data, kind)
    message.linear.x, message.linear.y = message.linear.y, message.linear.x
    return message


def shorten(data: bytes, kind: Any) -> Any:
    message = deserialize_message(data, kind)
    message.header.frame_id = ''
    return message


@pytest.mark.parametrize(
    ('message', 'patched', 'by', 'says'),
    [
        (Twist(), 'deserialize_message', refuse, 'geometry_msgs/Twist: failed to deserialize'),
        (Twist(), 'deserialize_message', swap, 'linear.x is not read as it was packed'),
        (NavSatFix(), 'deserialize_message', shorten, 'sensor_msgs/NavSatFix: header.frame_id is'),
        (
            Point(),
            'serialize_message',
            lambda message: b'\0\7' + serialize_message(message)[2:],
            'geometry_msgs/Point: it begins with 00 07, not 00 01',
        ),
    ],
)
def test_another_form_gives_one_line_and_ordinary_messages(
    message: Any, patched: str, by: Any, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if isinstance(message, NavSatFix):
        message.header.frame_id = 'base_link'
    monkeypatch.setattr(packed_message, patched, by)
    log, packed = Log(), PackedMessage(message)
    before = bytes(packed)
    form = proven_form([packed, PackedMessage(Point(x=1.0))], log)
    assert form(packed) == message
    assert form(PackedMessage(Point(x=1.0))) == Point(x=1.0)
    assert bytes(packed) == before
    (line,) = log
    assert says in line
    assert line.startswith('rmw_')
    assert line.endswith('publishing ordinary messages, which takes longer')
