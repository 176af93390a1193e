# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS interface of the driver."""

from husky_driver.ros.progress import Tally
from husky_driver.ros.readings import read_odometry

__all__ = ['Tally', 'read_odometry']
