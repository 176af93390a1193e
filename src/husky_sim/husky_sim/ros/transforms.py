# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""/tf and /tf_static, where tf2_msgs is installed; without it, nothing."""

from collections.abc import Mapping

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile

from husky_sim.messages.transforms import fixed_transforms, TFMessage, TransformsMessage
from husky_sim.world import FIXED_FRAMES, Frame

_QOS = QoSProfile(depth=100)
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def create_transform_topics(
    node: Node,
    namespace: str,
    *,
    localization: bool,
    fixed: Mapping[str, Frame] = FIXED_FRAMES,
) -> list[tuple[TransformsMessage, Publisher]]:
    """
    Publish what never moves, and return the message of what does with its publisher.

    Both topics are relative: /tf for the only robot, and a tree for each of many.

    :param fixed: frames that never move in base_link.
    :param localization: whether odom -> base_link is the simulator's.
    """
    if TFMessage is None:
        return []
    latched = node.create_publisher(TFMessage, f'{namespace}tf_static', _LATCHED)
    latched.publish(fixed_transforms(fixed))
    moving = TransformsMessage(localization=localization)
    return [(moving, node.create_publisher(TFMessage, f'{namespace}tf', _QOS))]
