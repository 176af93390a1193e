# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""/tf and /tf_static, where tf2_msgs is installed; without it, nothing."""

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile

from husky_sim.messages.transforms import fixed_transforms, TFMessage, TransformsMessage

_QOS = QoSProfile(depth=100)
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def create_transform_topics(
    node: Node, namespace: str, *, localization: bool
) -> list[tuple[TransformsMessage, Publisher]]:
    """
    Publish what never moves, and return the message of what does with its publisher.

    Both topics are relative: /tf for the only robot, and a tree for each of many.

    :param localization: whether odom -> base_link is the simulator's.
    """
    if TFMessage is None:
        return []
    node.create_publisher(TFMessage, f'{namespace}tf_static', _LATCHED).publish(fixed_transforms())
    moving = TransformsMessage(localization=localization)
    return [(moving, node.create_publisher(TFMessage, f'{namespace}tf', _QOS))]
