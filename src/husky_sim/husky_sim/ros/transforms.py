# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
/tf and /tf_static, where tf2_msgs is installed; without it, nothing.

odom -> base_link is what odometry/filtered says, as in the original, where the filter owns it;
with another filter it is that one's. Ground truth is never on tf (REP-105: one authority for
every edge).
"""

import math
from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from husky_sim.messages.messages import Stamp, time_message
from husky_sim.robot.husky import WHEELS
from husky_sim.simulation import SimulatedRobot

try:
    from tf2_msgs.msg import TFMessage
except ImportError:
    TFMessage = None

_WHEEL_X_M, _WHEEL_Y_M, _WHEEL_Z_M = 0.256, 0.2854, 0.03282
_FIXED = {
    'base_footprint': (0.0, 0.0, -0.13228),
    'imu_link': (0.19, 0.0, 0.149),
    'front_laser': (0.337, 0.0, 0.30795),
}


class TransformTopics:
    """Publishes the transforms of one robot."""

    def __init__(self, node: Node, namespace: str, *, localization: bool) -> None:
        self._publisher: Any = None
        if TFMessage is None:
            return
        # Relative: /tf for the only robot, and its own tree for each of many.
        topic = f'{namespace}tf'
        self._publisher = node.create_publisher(TFMessage, topic, QoSProfile(depth=100))
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._static = node.create_publisher(TFMessage, f'{topic}_static', latched)
        self._static.publish(
            TFMessage(
                transforms=[*(_moved('base_link', *item) for item in _FIXED.items()), _camera()]
            )
        )
        self._base = _moved('odom', 'base_link', (0.0, 0.0, 0.0))
        self._wheels = [_wheel(name) for name in WHEELS]
        moving = [self._base, *self._wheels] if localization else self._wheels
        self._message = TFMessage(transforms=moving)

    def publish(self, stamp: Stamp, robot: SimulatedRobot) -> None:
        """Publish where base_link and the wheels are."""
        if self._publisher is None:
            return
        time = time_message(stamp)
        estimate, base = robot.filtered, self._base.transform
        self._base.header.stamp = time
        base.translation.x, base.translation.y = estimate.x, estimate.y
        base.rotation.z, base.rotation.w = _half_turn(estimate.yaw)
        for wheel, angle_rad in zip(self._wheels, robot.wheels.angles_rad, strict=True):
            wheel.header.stamp = time
            wheel.transform.rotation.y, wheel.transform.rotation.w = _half_turn(angle_rad)
        self._publisher.publish(self._message)


def _half_turn(angle_rad: float) -> tuple[float, float]:
    """Return the two parts of a quaternion that turns about one axis."""
    return math.sin(angle_rad / 2.0), math.cos(angle_rad / 2.0)


def _camera() -> TransformStamped:
    """Return the optical frame: z forward, x to the right (REP-103)."""
    transform = _moved('base_link', 'camera', (0.45, 0.0, 0.29))
    rotation = transform.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = -0.5, 0.5, -0.5, 0.5
    return transform


def _wheel(name: str) -> TransformStamped:
    x = _WHEEL_X_M if name.startswith('front') else -_WHEEL_X_M
    y = _WHEEL_Y_M if name.endswith('left') else -_WHEEL_Y_M
    return _moved('base_link', f'{name}_wheel_link', (x, y, _WHEEL_Z_M))


def _moved(parent: str, child: str, by: tuple[float, float, float]) -> TransformStamped:
    transform = TransformStamped()
    transform.header.frame_id = parent
    transform.child_frame_id = child
    translation = transform.transform.translation
    translation.x, translation.y, translation.z = by
    return transform
