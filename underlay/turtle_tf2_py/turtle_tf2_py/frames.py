# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where a frame is in another."""

from __future__ import annotations

from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from tf2_py.motions import Quaternion, Vector

WORLD = 'world'
NOT_TURNED: Quaternion = (0.0, 0.0, 0.0, 1.0)


def placed(
    frame_id: str,
    child_frame_id: str,
    translation: Vector,
    rotation: Quaternion = NOT_TURNED,
    *,
    stamp: Time,
) -> TransformStamped:
    """Return the message that places a frame in another; metres, and x, y, z, w."""
    message = TransformStamped(child_frame_id=child_frame_id)
    message.header.stamp, message.header.frame_id = stamp, frame_id
    to, turn = message.transform.translation, message.transform.rotation
    to.x, to.y, to.z = translation
    turn.x, turn.y, turn.z, turn.w = rotation
    return message
