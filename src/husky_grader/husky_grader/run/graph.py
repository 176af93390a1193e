# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The graph around a program, as `diagnosis` takes it, from what a node of the grader sees."""

from collections.abc import Collection
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

from husky_grader.run.diagnosis import Endpoint, Graph


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
    return Graph(tuple(publishers), tuple(subscriptions), tuple(others))


def _endpoint(topic: str, info: Any) -> Endpoint:
    return Endpoint(
        topic,
        info.topic_type,
        reliable=info.qos_profile.reliability == ReliabilityPolicy.RELIABLE,
        transient_local=info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL,
    )
