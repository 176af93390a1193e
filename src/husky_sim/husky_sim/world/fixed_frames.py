# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The frames that never move in base_link (REP-105), after husky_description 0.6.10."""

from typing import NamedTuple


class Frame(NamedTuple):
    """Where a frame is in its parent: position in metres, quaternion w, x, y, z."""

    position_m: tuple[float, float, float]
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)


FIXED_FRAMES = {
    'base_footprint': Frame((0.0, 0.0, -0.13228)),
    'imu_link': Frame((0.19, 0.0, 0.149)),
    'front_laser': Frame((0.337, 0.0, 0.30795)),
    # Optical: z forward, x to the right (REP-103).
    'camera': Frame((0.45, 0.0, 0.29), (0.5, -0.5, 0.5, -0.5)),
}

CLEARPATH_FRAMES = {
    'imu_0_link': Frame((0.0, 0.0, 0.0)),
    'lidar2d_0_laser': FIXED_FRAMES['front_laser'],
    'gps_0_link': Frame((0.0, 0.0, 0.0)),
    'camera_0_color_optical_frame': FIXED_FRAMES['camera'],
}
"""
By the names of Clearpath's Sensors API, each where its sensor measures.

IMU and receiver do so at base_link, where Clearpath's sample of a robot.yaml has them as well.
"""
