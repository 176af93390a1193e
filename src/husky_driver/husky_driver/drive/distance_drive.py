# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Drive a distance straight on, as the lab sheet's questions ask for it."""

from __future__ import annotations

from functools import partial

from husky_course.frames import Pose, to_world
from husky_course.route import plan_route, Route
from husky_course.waypoints import Course, Waypoint

from husky_driver.drive.drive import Drive
from husky_driver.motion import Odometry


class DistanceDrive(Drive):
    """Drives straight ahead or back from wherever the robot starts."""

    def __init__(self, speed_m_s: float, distance_m: float, *, forward: bool = True) -> None:
        plan = partial(_straight_route, speed_m_s, distance_m if forward else -distance_m)
        super().__init__(plan((0.0, 0.0, 0.0)))
        self._plan = plan

    def _route_from(self, start: Odometry) -> Route:
        return self._plan((start.x_m, start.y_m, start.yaw_rad))


def _straight_route(speed_m_s: float, ahead_m: float, start: Pose) -> Route:
    begin = Waypoint(start[0], start[1])
    goal = Waypoint(*to_world(start, ahead_m, 0.0), reverse=ahead_m < 0.0)
    return plan_route(Course('distance', (begin, goal), speed_m_s=speed_m_s))
