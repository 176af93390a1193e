# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Check a route against the obstacles of a world, where an installed package can.

The driver itself runs without a world, on a robot's computer too. A package that checks routes
declares an entry point of the group `husky_driver.route_check`: a function as RouteCheck.
husky_grader does.
"""

from importlib.metadata import entry_points
from typing import Protocol

from husky_course.frames import Pose
from husky_course.route import NearPass, Route, Survey

GROUP = 'husky_driver.route_check'


class RouteCheck(Protocol):
    """Surveys a route; see husky_grader.playpen."""

    def __call__(self, route: Route, *, world: str, start: Pose) -> Survey:
        """Return the obstacles near the route."""


def near_passes(route: Route, *, world: str, start: Pose) -> list[NearPass]:
    """
    Return where the route passes too near to obstacles; nothing if no package checks it.

    :raises ValueError: when the world cannot be used.
    """
    checks: list[RouteCheck] = [entry.load() for entry in entry_points(group=GROUP)]
    return [near for check in checks for near in check(route, world=world, start=start).near]
