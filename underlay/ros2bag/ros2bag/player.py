# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Publish what a bag holds, at the times at which it was recorded."""

from __future__ import annotations

import argparse
from collections.abc import Collection, Iterator
import time
from typing import Any

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from ros2cli import discovery, interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import CommandNode
import rosbag2_py
from rosgraph_msgs.msg import Clock
from rtps_graph import names
from rtps_graph.graph import Role

from ros2bag.qos_overrides import DEFAULT_DEPTH

_MATCH_TIMEOUT_SEC = 2.0
_ONE_WAIT = Duration(seconds=0.05)  # in which an interrupt is not heard


def play(
    node: CommandNode,
    args: argparse.Namespace,
    bag: rosbag2_py.BagMetadata,
    publishers: dict[str, Any],
    clock: Any,
) -> None:
    first_ns = bag.starting_time.nanoseconds + int(args.start_offset * 1e9)
    end_ns = _end_ns(args, first_ns)
    start = time.monotonic()
    tick_sec = 1.0 / args.clock if args.clock else None
    next_tick = 0.0
    for topic, data, time_ns in _messages(args, list(publishers)):
        if time_ns < first_ns:
            continue
        if end_ns is not None and time_ns > end_ns:
            return
        due = (time_ns - first_ns) * 1e-9 / args.rate
        while (left := due - (time.monotonic() - start)) > 0:
            if tick_sec is not None and time.monotonic() - start >= next_tick:
                _publish_clock(clock, first_ns + int((time.monotonic() - start) * 1e9 * args.rate))
                next_tick += tick_sec
            # Sleeping is exact; the executor serves what little there is besides.
            time.sleep(min(left, 0.01))
            if left > 0.01:
                node.spin_once(0.0)
        publishers[topic].publish(data)


def _end_ns(args: argparse.Namespace, first_ns: int) -> int | None:
    """Return the time in the bag after which nothing is played; None for no such time."""
    ends = []
    if args.playback_duration > 0.0:
        ends.append(first_ns + int(args.playback_duration * 1e9))
    elif args.playback_duration == 0.0:  # as upstream, not even what comes at the start
        ends.append(-1)
    if args.playback_until_sec >= 0.0:
        ends.append(int(args.playback_until_sec * 1e9))
    if args.playback_until_nsec >= 0:
        ends.append(args.playback_until_nsec)
    return max(ends, default=None)


def _messages(args: argparse.Namespace, topics: list[str]) -> Iterator[tuple[str, bytes, int]]:
    reader = rosbag2_py.SequentialReader()
    options = rosbag2_py.StorageOptions(str(args.bag_path), args.storage)
    reader.open(options, rosbag2_py.ConverterOptions())
    reader.set_filter(rosbag2_py.StorageFilter(topics=topics, services_events=topics))
    while reader.has_next():
        yield reader.read_next()


def _publish_clock(publisher: Any, now_ns: int) -> None:
    msg = Clock()
    msg.clock.sec, msg.clock.nanosec = divmod(now_ns, 10**9)
    publisher.publish(msg)


def publishers_of(
    node: CommandNode,
    topics: list[rosbag2_py.TopicMetadata],
    remaps: dict[str, str],
    overrides: dict[str, QoSProfile],
) -> dict[str, Any]:
    """
    Return a publisher for each topic whose type is installed; say which are left out.

    :raises CommandError: there are topics, but no type of theirs is installed.
    """
    publishers, reasons = {}, []
    for topic in topics:
        full_name = names.expand(topic.name)
        qos = overrides.get(full_name) or _offered(topic)
        name = remaps.get(full_name, topic.name)
        try:
            message_class = interfaces.message(topic.type)
        except CommandError as error:
            reasons.append(f"Topic '{topic.name}' is left out: {error}")
            continue
        publishers[topic.name] = node.node.create_publisher(message_class, name, qos)
    if reasons and not publishers:
        raise CommandError('; '.join(reasons))
    for reason in reasons:
        node.node.get_logger().warning(reason)
    return publishers


def _offered(topic: rosbag2_py.TopicMetadata) -> QoSProfile:
    """Return what suits the subscriptions that suited the topic when it was recorded."""
    qos = QoSProfile(depth=DEFAULT_DEPTH)
    offers = [
        rosbag2_py.convert_rclcpp_qos_to_rclpy_qos(each) for each in topic.offered_qos_profiles
    ]
    if any(each.reliability != ReliabilityPolicy.RELIABLE for each in offers):
        qos.reliability = ReliabilityPolicy.BEST_EFFORT
    if offers and all(each.durability == DurabilityPolicy.TRANSIENT_LOCAL for each in offers):
        qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
    return qos


def wait_for_subscriptions(node: CommandNode, publishers: list[Any]) -> None:
    """Wait until the subscriptions that exist are matched, so that they get the first message."""
    graph = discovery.read_graph()
    wanted = {p.topic_name: len(graph.with_role(Role.SUBSCRIPTION, p.topic_name))
              for p in publishers}  # fmt: skip
    node.spin_until(
        lambda: all(p.get_subscription_count() >= wanted[p.topic_name] for p in publishers),
        _MATCH_TIMEOUT_SEC,
    )


def wait_for_acknowledgements(
    node: CommandNode, publishers: Collection[Any], timeout_sec: float | None
) -> None:
    """Wait until all that was published reliably has arrived, or the time is over.

    A subscription of a process that is stopped acknowledges nothing.
    """
    reliable = [p for p in publishers if p.qos_profile.reliability == ReliabilityPolicy.RELIABLE]
    node.spin_until(lambda: all(p.wait_for_all_acked(_ONE_WAIT) for p in reliable), timeout_sec)
