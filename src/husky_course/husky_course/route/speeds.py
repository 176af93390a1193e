# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
How fast a curve can be driven, and how long that takes.

Speed is regulated by curvature and by the distance to the end, as in regulated pure pursuit
(Macenski, Singh, Martin, Gines, arXiv 2305.20026).
"""

from collections.abc import Sequence
from dataclasses import dataclass
import math

from husky_course.route.path import Curve


@dataclass(frozen=True)
class DriveLimits:
    """What the Husky's velocity controller allows, and how much of it the tracker uses."""

    speed_m_s: float = 1.0
    yaw_rate_rad_s: float = 2.0
    acceleration_m_s2: float = 3.0
    yaw_acceleration_rad_s2: float = 6.0
    braking_m_s2: float = 1.2  # planned, gentle enough to stop on the point
    lateral_m_s2: float = 1.0  # in bends; wheels begin to slide at about 4
    bend_yaw_rate_rad_s: float = 1.5  # leaves the rest to the feedback
    turn_yaw_rate_rad_s: float = 2.0  # turning on the spot
    turn_braking_rad_s2: float = 4.5
    stopping_m_s2: float = 2.0  # what it counts on before an obstacle


LIMITS = DriveLimits()
A200_LIMITS = DriveLimits(
    yaw_rate_rad_s=1.0,
    acceleration_m_s2=1.0,
    yaw_acceleration_rad_s2=1.0,
    braking_m_s2=0.7,
    bend_yaw_rate_rad_s=0.75,
    turn_yaw_rate_rad_s=1.0,
    turn_braking_rad_s2=0.75,
    stopping_m_s2=0.7,
)
"""Of a real one: platform_velocity_controller of clearpath_control for ROS 2 Jazzy."""


def plan_speeds(
    curve: Curve, asked_m_s: Sequence[float], limits: DriveLimits = LIMITS
) -> list[float]:
    """
    Return the highest speed at every sample that bends, braking and the end allow.

    :param asked_m_s: the wished speed of each piece between two knots.
    """
    speeds: list[float] = []
    piece = 0
    for s, curvature in zip(curve.s, curve.curvature, strict=True):
        while piece < len(asked_m_s) - 1 and s >= curve.knot_s[piece + 1]:
            piece += 1
        bend = max(abs(curvature), 1e-6)
        bent = min(math.sqrt(limits.lateral_m_s2 / bend), limits.bend_yaw_rate_rad_s / bend)
        speeds.append(min(asked_m_s[piece], bent, limits.speed_m_s))
    speeds[-1] = 0.0
    for i in range(len(speeds) - 2, -1, -1):
        ds = curve.s[i + 1] - curve.s[i]
        braking = math.sqrt(speeds[i + 1] ** 2 + 2 * limits.braking_m_s2 * ds)
        speeds[i] = min(speeds[i], braking)
    return speeds
