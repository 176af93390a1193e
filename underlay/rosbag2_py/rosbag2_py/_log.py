# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is said on the way, by the logger that nodes have."""

from __future__ import annotations


def warn(text: str) -> None:
    import rclpy.logging

    rclpy.logging.get_logger('rosbag2_py').warning(text)
