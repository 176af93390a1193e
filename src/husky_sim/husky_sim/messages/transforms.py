# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The transforms of a robot, where tf2_msgs is installed: TFMessage is None without it.

odom -> base_link is what odometry/filtered says, as in the original, where the filter owns it;
with another filter it is that one's. Ground truth is never on tf (REP-105: one authority for
every edge).
"""

from collections.abc import Mapping
import math
from typing import Any

from geometry_msgs.msg import TransformStamped

from husky_sim.messages.messages import Stamp
from husky_sim.messages.packed_message import PackedMessage
from husky_sim.robot.husky import WHEELS
from husky_sim.simulation import SimulatedRobot
from husky_sim.world import FIXED_FRAMES, Frame

try:
    from tf2_msgs.msg import TFMessage
except ImportError:
    TFMessage = None

__all__ = ['TFMessage', 'TransformsMessage', 'fixed_transforms', 'new_transform']

_WHEEL_X_M, _WHEEL_Y_M, _WHEEL_Z_M = 0.256, 0.2854, 0.03282


class TransformsMessage(PackedMessage):
    """
    Where base_link and the wheels are.

    :param localization: whether odom -> base_link is among them.
    """

    def __init__(self, *, localization: bool = True) -> None:
        base = [new_transform('odom', 'base_link')] if localization else []
        moving = [*base, *map(_wheel, WHEELS)]
        super().__init__(TFMessage(transforms=moving))
        places = [self.places['transforms'][i] for i in range(len(moving))]
        self._stamps = [self.packer(place['header']['stamp']) for place in places]
        self._base = [self.packer(place['transform']) for place in places[: len(base)]]
        self._turns = [
            self.packer(place['transform']['rotation']) for place in places[len(base) :]
        ]

    def pack(self, stamp: Stamp, robot: SimulatedRobot) -> None:
        """Pack the filtered pose and the angles of the wheels."""
        estimate = robot.filtered
        for pack_stamp in self._stamps:
            pack_stamp(*stamp)
        for pack_base in self._base:
            pack_base(estimate.x, estimate.y, 0.0, 0.0, 0.0, *_half_turn(estimate.yaw))
        for pack_turn, angle_rad in zip(self._turns, robot.wheels.angles_rad, strict=True):
            y, w = _half_turn(angle_rad)
            pack_turn(0.0, y, 0.0, w)


def fixed_transforms(frames: Mapping[str, Frame] = FIXED_FRAMES) -> Any:
    """Return the message of what never moves in base_link."""
    return TFMessage(transforms=[_fixed(*item) for item in frames.items()])


def _half_turn(angle_rad: float) -> tuple[float, float]:
    """Return the two parts of a quaternion that turns about one axis."""
    return math.sin(angle_rad / 2.0), math.cos(angle_rad / 2.0)


def _fixed(name: str, frame: Frame) -> TransformStamped:
    transform = new_transform('base_link', name, frame.position_m)
    rotation = transform.transform.rotation
    rotation.w, rotation.x, rotation.y, rotation.z = frame.orientation
    return transform


def _wheel(name: str) -> TransformStamped:
    x = _WHEEL_X_M if name.startswith('front') else -_WHEEL_X_M
    y = _WHEEL_Y_M if name.endswith('left') else -_WHEEL_Y_M
    return new_transform('base_link', f'{name}_wheel_link', (x, y, _WHEEL_Z_M))


def new_transform(
    parent: str, child: str, by: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> TransformStamped:
    """Return where a frame stands in another, turned like it."""
    transform = TransformStamped()
    transform.header.frame_id = parent
    transform.child_frame_id = child
    translation = transform.transform.translation
    translation.x, translation.y, translation.z = by
    return transform
