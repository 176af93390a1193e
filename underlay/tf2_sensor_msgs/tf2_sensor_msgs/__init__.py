# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Point clouds taken into another frame."""

from tf2_sensor_msgs.tf2_sensor_msgs import (
    do_transform_cloud,
    from_msg_msg,
    to_msg_msg,
    transform_points,
)

__all__ = ['do_transform_cloud', 'from_msg_msg', 'to_msg_msg', 'transform_points']
