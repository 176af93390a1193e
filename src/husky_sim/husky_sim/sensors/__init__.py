# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The sensors of the robot, and the estimate of its pose."""

from husky_sim.sensors.camera import Camera
from husky_sim.sensors.lidar import Lidar, new_noise, RANGE_MAX_M
from husky_sim.sensors.ray_scene import RayScene
from husky_sim.sensors.sensors import Rate

__all__ = ['RANGE_MAX_M', 'Camera', 'Lidar', 'Rate', 'RayScene', 'new_noise']
