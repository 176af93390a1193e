# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Courses of a rubric that go through something."""

from collections.abc import Iterator
from pathlib import Path

from husky_course.route import plan_route, survey_route
from husky_course.waypoints import load_course

from husky_grader.playpen import obstacles_of
from husky_grader.rubric.steps import Rubric


def impossible_courses(rubric: Rubric) -> Iterator[str]:
    """Yield a line on each course on which a robot that keeps to it touches something."""
    if not rubric.courses:
        return
    obstacles = obstacles_of(rubric.world)
    for course in rubric.courses:
        if touched := survey_route(plan_route(load_course(course)), obstacles).touched:
            where = Path(rubric.world).name if rubric.world else 'the playpen'
            yield (
                f'{rubric.file}: the course {course.name} goes through {" and ".join(touched)} in '
                f'{where}, so that a robot that keeps to it touches that; change the course, or '
                'name another world by `world: FILE` in the rubric'
            )
