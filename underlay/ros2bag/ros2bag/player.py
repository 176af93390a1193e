# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The publishers of what a bag holds, and those who hear them."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from rclpy.duration import Duration
from rclpy.exceptions import InvalidTopicNameException
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from ros2cli import discovery, interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import CommandNode
import rosbag2_py
from rtps_graph import names
from rtps_graph.graph import Role

from ros2bag.qos_overrides import DEFAULT_DEPTH

_MATCH_TIMEOUT_SEC = 2.0
_ONE_WAIT = Duration(seconds=0.05)  # in which an interrupt is not heard


def publishers_of(
    node: CommandNode,
    topics: list[rosbag2_py.TopicMetadata],
    remaps: dict[str, str],
    overrides: dict[str, QoSProfile],
    *,
    are_all: bool,
) -> dict[str, Any]:
    """
    Return a publisher for each topic whose type is installed; say which are left out.

    So is one with a name that ROS 2 does not take, as bags have that were made of those of ROS 1.

    :param are_all: whether nothing is played but these.
    :raises CommandError: there are topics, but all are left out, and nothing is played.
    """
    publishers, reasons = {}, []
    for topic in topics:
        full_name = names.expand(topic.name)
        qos = overrides.get(full_name) or _offered(topic)
        name = remaps.get(full_name, topic.name)
        try:
            message_class = interfaces.message(topic.type)
            publishers[topic.name] = node.node.create_publisher(message_class, name, qos)
        except CommandError as error:
            reasons.append(f"Topic '{topic.name}' is left out: {error}")
        except InvalidTopicNameException:
            reasons.append(
                f"Topic '{topic.name}' is left out: '{name}' is no name of a topic: letters, "
                'digits and _ between /, no digit behind /; '
                f"--remap '{full_name}:=/NAME' gives it one"
            )
    if reasons and not publishers and are_all:
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
