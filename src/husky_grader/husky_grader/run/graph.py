# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The graph around a program, as `diagnosis` takes it, from what a node of the grader sees."""

from collections.abc import Collection
import math
from typing import Any

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, ReliabilityPolicy
from rclpy.type_hash import TypeHash

from husky_grader.run.diagnosis import Endpoint, Graph
from husky_grader.run.elsewhere import domain_elsewhere

_NEVER_NS = 2**31 * 10**9  # DDS counts seconds in 32 bits, and has the largest for never
_NO_HASH = str(TypeHash())  # of a publisher whose DDS tells none


def read_graph(node: Node, ours: Collection[str]) -> Graph:
    """
    Return the graph as a node sees it now.

    :param ours: names of the nodes that are not the program's.
    """
    publishers: list[Endpoint] = []
    subscriptions: list[Endpoint] = []
    others: list[Endpoint] = []
    for topic, _ in node.get_topic_names_and_types():
        for info in node.get_publishers_info_by_topic(topic):
            (others if info.node_name in ours else publishers).append(_endpoint(topic, info))
        for info in node.get_subscriptions_info_by_topic(topic):
            if info.node_name not in ours:
                subscriptions.append(_endpoint(topic, info))
    is_here = publishers or subscriptions
    elsewhere = None if is_here else domain_elsewhere(node.context.get_domain_id())
    return Graph(tuple(publishers), tuple(subscriptions), tuple(others), elsewhere)


def has_other_fields(node: Node, topic: str, type_name: str) -> bool:
    """
    Tell whether a publisher's type has the name of a type, and other fields.

    It is compared with what the node itself listens to. A middleware may show a node its own new
    subscription after the publishers of others (Cyclone DDS does): so long, nothing is told.
    """
    hashes_here = {
        str(each.topic_type_hash)
        for each in node.get_subscriptions_info_by_topic(topic)
        if each.node_name == node.get_name()
    }
    return bool(hashes_here) and any(
        each.topic_type == type_name and str(each.topic_type_hash) not in {_NO_HASH, *hashes_here}
        for each in node.get_publishers_info_by_topic(topic)
    )


def _endpoint(topic: str, info: Any) -> Endpoint:
    return Endpoint(
        topic,
        info.topic_type,
        reliable=info.qos_profile.reliability == ReliabilityPolicy.RELIABLE,
        transient_local=info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL,
        deadline_sec=_seconds(info.qos_profile.deadline),
        manual_liveliness=info.qos_profile.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC,
        lease_sec=_seconds(info.qos_profile.liveliness_lease_duration),
    )


def _seconds(duration: Duration) -> float:
    """Return a time; none that was set is as long as the middleware can say."""
    return duration.nanoseconds / 1e9 if 0 < duration.nanoseconds < _NEVER_NS else math.inf
