# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the graph tells about a controller that is not heard: topic, type, quality of service."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy

WANTED_TYPE = 'geometry_msgs/msg/Twist'
VELOCITY_TYPES = (WANTED_TYPE, 'geometry_msgs/msg/TwistStamped')


def controller_hints(node: Node, topic: str, own: Sequence[str]) -> list[str]:
    """
    Return what is wrong with how commands are published, seen from a node in the same graph.

    :param topic: where the robot listens, fully qualified.
    :param own: names of the nodes that are not the controller's.
    """
    publishers = [info for info in node.get_publishers_info_by_topic(topic) if _is_its(info, own)]
    hints = [hint for info in publishers for hint in _wrong(info, topic)]
    if publishers:
        return hints
    elsewhere = _elsewhere(node, topic, own)
    return [
        f'it publishes {kind} on {name}; the Husky listens on {topic}' for name, kind in elsewhere
    ]


def _is_its(info: Any, own: Sequence[str]) -> bool:
    return info.node_name not in own


def _wrong(info: Any, topic: str) -> list[str]:
    hints = []
    if info.topic_type != WANTED_TYPE:
        hints.append(f'it publishes {info.topic_type} on {topic}; the Husky takes {WANTED_TYPE}')
    if info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT:
        hints.append(
            f'it publishes {topic} best effort; the Husky listens reliably and hears nothing'
        )
    return hints


def _elsewhere(node: Node, topic: str, own: Sequence[str]) -> list[tuple[str, str]]:
    found = []
    for name, kinds in sorted(node.get_topic_names_and_types()):
        velocity = [kind for kind in kinds if kind in VELOCITY_TYPES]
        if name != topic and velocity:
            infos = node.get_publishers_info_by_topic(name)
            if any(_is_its(info, own) for info in infos):
                found.append((name, velocity[0]))
    return found
