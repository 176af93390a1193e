# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""From odometry to velocity commands along a route; without ROS."""

from husky_driver.drive.drive import Drive
from husky_driver.drive.time_limit import NEARER_M, TimeLimit

__all__ = ['NEARER_M', 'Drive', 'TimeLimit']
