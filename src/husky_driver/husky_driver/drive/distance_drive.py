# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Drive a distance straight on, as the lab sheet's questions ask for it."""

from __future__ import annotations

import math

from husky_course.route import plan_route, Route
from husky_course.waypoints import Course, Waypoint

from husky_driver.drive.drive import Drive
from husky_driver.motion import Odometry


class DistanceDrive(Drive):
    """Drives straight ahead or back from wherever the robot starts."""

    def __init__(self, speed_m_s: float, distance_m: float, *, forward: bool = True) -> None:
        self._ahead_m = distance_m if forward else -distance_m
        self._speed_m_s = speed_m_s
        super().__init__(self._route_from(Odometry(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)))

    def _route_from(self, start: Odometry) -> Route:
        x = start.x_m + self._ahead_m * math.cos(start.yaw_rad)
        y = start.y_m + self._ahead_m * math.sin(start.yaw_rad)
        goal = Waypoint(x, y, reverse=self._ahead_m < 0.0)
        begin = Waypoint(start.x_m, start.y_m)
        return plan_route(Course('distance', (begin, goal), speed_m_s=self._speed_m_s))
