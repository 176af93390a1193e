# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topic robot_description, where robot_state_publisher has it: what the robot looks like."""

from collections.abc import Mapping
from pathlib import Path

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from husky_sim.world import Frame, urdf_of

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def publish_description(
    node: Node, namespace: str, husky: str, fixed: Mapping[str, Frame]
) -> None:
    """
    Publish the URDF of a robot, for whoever asks at any time.

    :param husky: the robot's file; one with shapes that URDF lacks is told of, and not published.
    :param fixed: the frames that never move in base_link.
    """
    try:
        text = urdf_of(Path(husky), fixed)
    except ValueError as error:
        node.get_logger().warning(f'{husky}: no robot_description: {error}')
        return
    node.create_publisher(String, f'{namespace}robot_description', _LATCHED).publish(
        String(data=text)
    )
