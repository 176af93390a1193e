# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Looks for obstacles of a world beside a route, before anything moves."""

from __future__ import annotations

from husky_course.robot import RobotStart
from husky_course.route import Pose, Route, Survey, survey_route
from husky_sim.errors import SimulatorError
from husky_sim.world import default_worlds, load_world


def check_route(route: Route, *, world: str = '', start: Pose = (0.0, 0.0, 0.0)) -> Survey:
    """
    Return where the robot, driving exactly on the course, would come too near to an obstacle.

    :param world: MJCF file; empty: the playpen.
    :raises ValueError: when the world cannot be used.
    """
    file = world or str(default_worlds() / 'playpen.xml')
    x, y, yaw = start
    try:
        obstacles = load_world(file, (RobotStart(x=x, y=y, yaw=yaw),)).obstacles
    except SimulatorError as error:
        raise ValueError(str(error)) from None
    return survey_route(route, obstacles, start=start)
