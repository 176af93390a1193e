# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Looks for obstacles of a world beside a course, before anything moves."""

from __future__ import annotations

from husky_course.obstacles.survey import Pose, Survey, survey
from husky_course.robot import RobotStart
from husky_course.waypoints.waypoint_file import Course
from husky_sim.errors import SimulatorError
from husky_sim.world.world import default_worlds, load_world


def check_course(course: Course, *, world: str = '', start: Pose = (0.0, 0.0, 0.0)) -> Survey:
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
    return survey(course, obstacles, start=start)
