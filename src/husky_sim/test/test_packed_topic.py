# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whichever way a packed message is sent, what arrives says what was packed."""

from collections.abc import Iterator
import time
from typing import Any

from husky_sim.messages.messages import ClockMessage
from husky_sim.messages.packed_message import PackedMessage
from husky_sim.ros.packed_topic import PackedTopic
from playpen_testing.waiting import wait_until
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rosgraph_msgs.msg import Clock

DEPTH = 1000  # with less, of messages by turns those of one kind may be dropped each time


class Elsewhere:
    """A publisher whose handle cannot send bytes, as that of another rclpy may not."""

    def __init__(self, publisher: Any) -> None:
        self.publish, self.handle = publisher.publish, object()


@pytest.fixture
def node(domain_id: int) -> Iterator[Node]:
    context = Context()
    rclpy.init(context=context, domain_id=domain_id)
    made = rclpy.create_node('packed', context=context)
    yield made
    made.destroy_node()
    context.try_shutdown()


@pytest.mark.parametrize(
    ('form', 'of'),
    [
        (bytes, lambda publisher: publisher),
        (bytes, Elsewhere),
        (PackedMessage.unpacked, Elsewhere),
    ],
)
def test_what_is_packed_arrives(node: Node, form: Any, of: Any) -> None:
    heard: set[tuple[int, int]] = set()
    node.create_subscription(
        Clock, '/told', lambda said: heard.add((said.clock.sec, said.clock.nanosec)), DEPTH
    )
    topic = PackedTopic(ClockMessage(), of(node.create_publisher(Clock, '/told', DEPTH)), form)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    deadline = time.monotonic() + 20.0
    while heard != {(1, 2), (3, 7)}:
        assert time.monotonic() < deadline, f'heard {heard}'
        assert heard <= {(1, 2), (3, 7)}
        topic.pack((1, 2))
        topic.publish()
        topic.pack((3, 7))  # what was sent before does not change
        executor.spin_once(timeout_sec=0.02)
        topic.publish()
    executor.shutdown()


def test_without_a_subscription_nobody_reads(node: Node) -> None:
    topic = PackedTopic(ClockMessage(), node.create_publisher(Clock, '/told', 10), bytes)
    assert not topic.is_read
    node.create_subscription(Clock, '/told', lambda _: None, 10)
    wait_until(lambda: topic.is_read, timeout_sec=20.0, what='a subscription that counts')


def test_a_destroyed_publisher_refuses(node: Node) -> None:
    topic = PackedTopic(ClockMessage(), node.create_publisher(Clock, '/told', 10), bytes)
    node.destroy_publisher(topic.publisher)
    with pytest.raises(Exception, match='publisher'):
        topic.publish()
