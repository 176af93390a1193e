# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The playpen: the courses that come with the lab, and routes checked against its obstacles."""

from collections.abc import Sequence
from pathlib import Path

from husky_course.frames import Pose
from husky_course.outline import Outline
from husky_course.robot import RobotStart
from husky_course.route import Route, Survey, survey_route


def config_folder() -> Path:
    """Return the folder of the configuration: in the source, or as installed."""
    in_source = Path(__file__).resolve().parents[3] / 'config'
    if in_source.is_dir():
        return in_source
    from ament_index_python.packages import get_package_share_directory

    return Path(get_package_share_directory('husky_driver')) / 'config'


def default_course() -> Path:
    """Return the course that is driven when none is named."""
    return config_folder() / 'waypoints' / 'central_barrier.yaml'


def default_rubric() -> Path:
    """Return the rubric of the lab sheet."""
    return config_folder() / 'rubrics' / 'ros_packages_and_topics.yaml'


def check_route(route: Route, *, world: str = '', start: Pose = (0.0, 0.0, 0.0)) -> Survey:
    """
    Return where the robot, driving exactly on the course, would come too near to an obstacle.

    :param world: MJCF file; empty: the playpen.
    :raises ValueError: when the world cannot be used.
    """
    return survey_route(route, obstacles_of(world, start), start=start)


def obstacles_of(world: str, start: Pose = (0.0, 0.0, 0.0)) -> Sequence[Outline]:
    """
    Return the obstacles of a world in which a robot starts there.

    :param world: MJCF file; empty: the playpen.
    :raises ValueError: when the world cannot be used.
    """
    from husky_sim.errors import SimulatorError
    from husky_sim.world import default_worlds, load_world  # MuJoCo takes its time

    file = world or str(default_worlds() / 'playpen.xml')
    x, y, yaw = start
    try:
        return load_world(file, (RobotStart(x=x, y=y, yaw=yaw),)).obstacles
    except SimulatorError as error:
        raise ValueError(str(error)) from None
