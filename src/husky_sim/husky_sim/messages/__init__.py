# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""ROS messages in serialized form, of which only the numbers change."""

from husky_sim.messages.messages import new_collision, OdometryMessage, ScanMessage
from husky_sim.messages.packed_message import PackedMessage
from husky_sim.messages.transforms import fixed_transforms, new_transform, TFMessage

__all__ = [
    'OdometryMessage',
    'PackedMessage',
    'ScanMessage',
    'TFMessage',
    'fixed_transforms',
    'new_collision',
    'new_transform',
]
