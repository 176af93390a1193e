# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Asks who knows the obstacles of a world whether a course passes too near to them.

The driver knows none: it runs on a robot's computer too. A package that does declares an entry
point of the group `husky_driver.course_check`: a function as CourseCheck. husky_grader does.
"""

from __future__ import annotations

from importlib.metadata import entry_points
from typing import Protocol

from husky_course.obstacles.survey import NearPass, Pose, Survey
from husky_course.waypoints.waypoint_file import Course

GROUP = 'husky_driver.course_check'


class CourseCheck(Protocol):
    """Looks along a course; see husky_grader.world_check."""

    def __call__(self, course: Course, *, world: str, start: Pose) -> Survey:
        """Return what is near the course."""


def near_passes(course: Course, *, world: str, start: Pose) -> list[NearPass]:
    """
    Return where the course passes too near to obstacles, as far as an installed package knows.

    :raises ValueError: when the world cannot be used.
    """
    checks: list[CourseCheck] = [entry.load() for entry in entry_points(group=GROUP)]
    return [near for check in checks for near in check(course, world=world, start=start).near]
