# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Bytes that are those of no message: dropped, whoever sends them, and the receiver goes on."""

from __future__ import annotations

import json
from random import Random
import subprocess
import sys
import time
from typing import Any

from husky_runtime.domains import in_own_domain
from playpen_testing.fast_dds import without_port_race
from playpen_testing.random_messages import random_message
import pytest
import rclpy
from rclpy.serialization import deserialize_message
from rosidl_runtime_py.utilities import get_message
from rosidl_typesupport_python.cdr import codec_of
from simulation_interfaces.msg import EntityFilters
from simulation_interfaces.srv import GetEntitiesStates, ResetSimulation

HEADER = b'\0\1\0\0'  # CDR, little endian
LENGTHS = [
    bytes.fromhex(each) for each in ('ffffffff', 'ffffff7f', '00000080', '00000100', '00' * 4)
]
PATIENCE_SEC = 60.0
MESSAGES = 1500
LISTENER = """
import json
import resource

import rclpy
from simulation_interfaces.msg import EntityFilters

heard = []
rclpy.init()
node = rclpy.create_node('listener')
node.create_subscription(EntityFilters, 'filters', lambda each: heard.append(each.filter), 2000)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
while 'the end' not in heard:
    rclpy.spin_once(node)
grown_kb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
print(json.dumps([len(heard), grown_kb]))
"""


def hostile(kind: Any, random: Random) -> bytes:
    """Return the bytes of a message with one to three mistakes, or bytes of no message at all."""
    if random.random() < 0.2:
        return random.randbytes(random.randint(0, 200))
    data = bytearray(codec_of(kind).encode(random_message(kind, random)))
    for _ in range(random.randint(1, 3)):
        place = random.randint(0, len(data))
        what = random.randrange(5)
        if what == 0:
            del data[place:]
        elif what == 1:
            data[place & ~3 : (place & ~3) + 4] = random.choice(LENGTHS)
        elif what == 2:
            data[place : place + 1] = random.randbytes(1)
        elif what == 3:
            data[place:place] = random.randbytes(random.randint(0, 9))
        else:
            data += bytes(40)
    return bytes(data)


@pytest.mark.parametrize(
    'kind',
    [
        *(EntityFilters, GetEntitiesStates.Response, ResetSimulation.Request),
        *map(get_message, ('example_interfaces/msg/WString', 'tf2_msgs/msg/TFMessage')),
    ],
)
def test_bytes_are_dropped_exactly_where_they_are_no_message(kind: Any) -> None:
    random, verdicts = Random(kind.__name__), set()
    for _ in range(400):
        data = hostile(kind, random)
        try:
            read = codec_of(kind).decode(data)
        except ValueError:
            read = None
        try:
            taken = deserialize_message(HEADER + data, kind)
        except RuntimeError:  # RMWError
            taken = None
        assert (read is None) == (taken is None), data.hex()
        verdicts.add(taken is None)
    assert verdicts == {False, True}


def test_a_subscriber_outlives_bytes_that_are_no_message() -> None:
    random, good = Random(0), EntityFilters(filter='the end')
    with in_own_domain():
        listener = subprocess.Popen(
            [sys.executable, '-c', LISTENER],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        rclpy.init()
        try:
            publisher = rclpy.create_node('sender').create_publisher(
                EntityFilters, 'filters', 2000
            )
            end_sec = time.monotonic() + PATIENCE_SEC
            while publisher.get_subscription_count() == 0:
                assert time.monotonic() < end_sec, 'the listener was not found'
                time.sleep(0.01)
            for _ in range(MESSAGES):
                header = HEADER if random.random() < 0.95 else random.randbytes(4)
                publisher.publish(header + hostile(EntityFilters, random))
            publisher.publish(good)
            out, err = listener.communicate(timeout=PATIENCE_SEC)
        finally:
            listener.kill()
            rclpy.shutdown()
    assert listener.returncode == 0, err
    heard, grown_kb = json.loads(without_port_race(out))
    assert 0 < heard < MESSAGES
    assert grown_kb < 20_000
    assert err.count('not those of simulation_interfaces/msg/EntityFilters') == 1
