# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`tf2_ros.Buffer` without a node: who waits for a transform, and who no longer does."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import TransformStamped
import pytest
from rclpy.duration import Duration
from rclpy.time import Time
from tf2_ros import Buffer, LookupException

NOW = Time(seconds=5)
SIMPLE = ('a', 'b', NOW)
FULL = ('a', NOW, 'b', NOW, 'a')
LONG = Duration(seconds=30)


def transform() -> TransformStamped:
    made = TransformStamped(child_frame_id='b')
    made.header.frame_id, made.header.stamp = 'a', NOW.to_msg()
    made.transform.translation.x, made.transform.rotation.w = 3.0, 1.0
    return made


def arrive(buffer: Buffer) -> None:
    buffer.set_transform(transform(), 'test')


@pytest.fixture
def buffer() -> Buffer:
    return Buffer()


WAITS = [
    lambda buffer, timeout: buffer.lookup_transform(*SIMPLE, timeout),
    lambda buffer, timeout: buffer.lookup_transform_full(*FULL, timeout),
]


@pytest.mark.parametrize('look_up', WAITS)
def test_a_lookup_waits_until_its_timeout(
    buffer: Buffer, look_up: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(LookupException):
        look_up(buffer, Duration(nanoseconds=1))
    monkeypatch.setattr('tf2_ros.buffer.sleep', lambda _: arrive(buffer))
    with pytest.raises(LookupException):
        look_up(buffer, Duration())
    assert look_up(buffer, LONG).transform.translation.x == 3.0


@pytest.mark.parametrize(
    ('ask', 'asked'), [(Buffer.can_transform, SIMPLE), (Buffer.can_transform_full, FULL)]
)
def test_what_lacks_is_told_to_who_asks_for_it(
    buffer: Buffer, ask: Callable[..., Any], asked: tuple[Any, ...]
) -> None:
    can, why = ask(buffer, *asked, return_debug_tuple=True)
    assert not can
    assert '"a"' in why
    assert not ask(buffer, *asked)
    arrive(buffer)
    assert ask(buffer, *asked)
    assert ask(buffer, *asked, return_debug_tuple=True) == (1, '')


@pytest.mark.parametrize(
    ('look_up', 'asked'),
    [(Buffer.lookup_transform_async, SIMPLE), (Buffer.lookup_transform_full_async, FULL)],
)
def test_to_await_a_lookup_takes_until_it_is_there(
    buffer: Buffer, look_up: Callable[..., Any], asked: tuple[Any, ...]
) -> None:
    waits = look_up(buffer, *asked)
    waits.send(None)
    waits.send(None)
    arrive(buffer)
    with pytest.raises(StopIteration) as ended:
        waits.send(None)
    assert ended.value.value.transform.translation.x == 3.0


def test_a_static_transform_ends_a_wait_too(buffer: Buffer) -> None:
    future = buffer.wait_for_transform_full_async(*FULL)
    assert not future.done()
    buffer.set_transform_static(transform(), 'test')
    assert future.result().transform.translation.x == 3.0


def test_who_has_waited_is_asked_no_more(buffer: Buffer, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []
    can = buffer.can_transform_core

    def counted(*which: Any) -> Any:
        asked.append(which)
        return can(*which)

    monkeypatch.setattr(buffer, 'can_transform_core', counted)
    served, settled = (buffer.wait_for_transform_async(*SIMPLE) for _ in range(2))
    settled.set_result(None)
    arrive(buffer)
    assert served.result().transform.translation.x == 3.0
    assert settled.result() is None
    assert len(asked) == 3  # once each, and once more the one that waited
    for _ in range(2):
        arrive(buffer)
    assert len(asked) == 3
    assert buffer._new_data_callbacks == []  # none of them is kept for ever


def test_what_goes_wrong_is_told_to_who_waits(
    buffer: Buffer, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise LookupException('gone')

    future = buffer.wait_for_transform_async(*SIMPLE)
    monkeypatch.setattr(buffer, 'lookup_transform_core', broken)
    arrive(buffer)
    with pytest.raises(LookupException, match='gone'):
        future.result()
