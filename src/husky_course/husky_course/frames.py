# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Places between the frames `world` and `odom`, which begins where the robot starts (REP-105).

The functions take numbers or numpy arrays, and give the same bits for both.
"""

import math
from typing import TypeVar

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]
Number = TypeVar('Number', float, Array)

Pose = tuple[float, float, float]
"""x and y in metres, yaw in radians."""


def to_world(start: Pose, x: Number, y: Number) -> tuple[Number, Number]:
    """
    Return places of the frame odom in the frame world.

    :param start: where the robot starts in the frame world.
    """
    x0, y0, yaw = start
    cos, sin = math.cos(yaw), math.sin(yaw)
    return x0 + cos * x - sin * y, y0 + sin * x + cos * y


def to_odom(start: Pose, x: Number, y: Number) -> tuple[Number, Number]:
    """
    Return places of the frame world in the frame odom.

    :param start: where the robot starts in the frame world.
    """
    x0, y0, yaw = start
    cos, sin = math.cos(yaw), math.sin(yaw)
    dx, dy = x - x0, y - y0
    return cos * dx + sin * dy, cos * dy - sin * dx


def wrapped(angle_rad: float) -> float:
    """Return an angle in the range from -pi to pi."""
    return math.remainder(angle_rad, math.tau)
