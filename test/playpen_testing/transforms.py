# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Transforms of tf2 in one line each, and buffers of them."""

from geometry_msgs.msg import TransformStamped
from rclpy.time import Time
from tf2_py import BufferCore

LATEST = Time()
NO_TURN = (0.0, 0.0, 0.0, 1.0)


def seconds(time_sec: float) -> Time:
    return Time(nanoseconds=round(time_sec * 1e9))


def transform(
    parent: str,
    child: str,
    time_sec: float = 0.0,
    translation: tuple[float, ...] = (0.0, 0.0, 0.0),
    rotation: tuple[float, ...] = NO_TURN,
) -> TransformStamped:
    message = TransformStamped()
    message.header.frame_id, message.child_frame_id = parent, child
    message.header.stamp = seconds(time_sec).to_msg()
    to = message.transform.translation
    to.x, to.y, to.z = translation
    turn = message.transform.rotation
    turn.x, turn.y, turn.z, turn.w = rotation
    return message


def buffer_of(*transforms: TransformStamped, static: bool = False) -> BufferCore:
    buffer = BufferCore()
    for each in transforms:
        (buffer.set_transform_static if static else buffer.set_transform)(each, 'test')
    return buffer
