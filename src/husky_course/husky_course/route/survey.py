# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Look along a route, before anything moves, for obstacles that the robot would pass too near."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
import math

import numpy as np

from husky_course.frames import Array, Indices, Pose, to_world
from husky_course.outline import clearances, Outline
from husky_course.route.legs import Leg
from husky_course.route.route import Route
from husky_course.waypoints.course import Course

ENOUGH_M = 0.15  # what a good drive may be off the path, and a little
STEP_M = 0.05
TURN_STEP_RAD = 0.1


@dataclass(frozen=True)
class NearPass:
    """Where the robot would come too near; `waypoint` is the one it drives to."""

    waypoint: int
    line: int
    obstacle: str
    clearance_m: float
    x: float  # in the frame world
    y: float

    @property
    def touches(self) -> bool:
        return self.clearance_m <= 0.0

    def __str__(self) -> str:
        """Return the warning for the person who wrote the course."""
        how = 'touches' if self.touches else f'passes {self.clearance_m:.2f} m from'
        return (
            f'line {self.line}: on the way to waypoint {self.waypoint + 1} the robot {how} '
            f'{self.obstacle} near ({self.x:.2f}, {self.y:.2f}); keep {ENOUGH_M} m from '
            'its bumpers and wheels'
        )


@dataclass(frozen=True)
class Survey:
    """What was found along a route."""

    obstacles: tuple[Outline, ...]
    near: tuple[NearPass, ...]
    least_m: float | None
    nearest: str

    @property
    def touched(self) -> tuple[str, ...]:
        """The obstacles that the robot would drive into, in the order of the way."""
        return tuple(dict.fromkeys(near.obstacle for near in self.near if near.touches))


def survey_route(
    route: Route, obstacles: Sequence[Outline], *, start: Pose = (0.0, 0.0, 0.0)
) -> Survey:
    """
    Return where the robot, driving exactly on the course, would come too near to an obstacle.

    :param start: where the robot starts in the frame world: m, m, rad.
    """
    found = tuple(obstacles)
    if not found:
        return Survey(found, (), None, '')
    poses, numbers = poses_along(route, start)
    parts: dict[str, list[Outline]] = {}  # of each obstacle
    for outline in found:
        parts.setdefault(outline.name, []).append(outline)
    names = list(parts)
    table = np.array([clearances(poses, parts[name]) for name in names])
    nearest = int(table.min(axis=1).argmin())
    return Survey(
        obstacles=found,
        near=tuple(_near_passes(route.course, poses, numbers, table, names)),
        least_m=float(table.min()),
        nearest=names[nearest],
    )


def _near_passes(
    course: Course, poses: Array, numbers: Indices, table: Array, names: list[str]
) -> list[NearPass]:
    """Return the nearest place for each pair of waypoint and obstacle, in the order of the way."""
    passes = []
    for number in sorted(set(numbers.tolist())):
        part = np.nonzero(numbers == number)[0]
        nearest = table[:, part].argmin(axis=1)
        for place in np.argsort(nearest, kind='stable'):
            k = part[nearest[place]]
            if table[place, k] < ENOUGH_M:
                x, y, _ = poses[k]
                waypoint = number % len(course.waypoints)
                line = course.waypoints[waypoint].line
                clearance_m = float(table[place, k])
                passes.append(
                    NearPass(waypoint, line, names[place], clearance_m, float(x), float(y))
                )
    return passes


def poses_along(route: Route, start: Pose) -> tuple[Array, Indices]:
    """
    Return all poses of a robot that drives exactly so, also to the first waypoint and in turns.

    :returns: x, y and yaw in the frame world, and the number of the waypoint each one leads to.
    """
    poses: list[Pose] = []
    numbers: list[int] = []
    heading = 0.0
    for leg in route.begun_at((0.0, 0.0)).legs:
        turn = _turn(leg.curve.x[0], leg.curve.y[0], heading, leg.begin_yaw_rad)
        poses += turn
        numbers += [leg.first + 1] * len(turn)
        for pose, number in _drive(leg):
            poses.append(pose)
            numbers.append(number)
        heading = leg.arrival_yaw_rad
        if leg.end_yaw_rad is not None:
            turn = _turn(leg.curve.x[-1], leg.curve.y[-1], heading, leg.end_yaw_rad)
            poses += turn
            numbers += [leg.last] * len(turn)
            heading = leg.end_yaw_rad
    x, y, yaw = np.array(poses).T
    table = np.stack([*to_world(start, x, y), yaw + start[2]], axis=1)
    return table, np.array(numbers)


def _turn(x: float, y: float, begin: float, end: float) -> list[Pose]:
    angle = math.remainder(end - begin, 2 * math.pi)
    count = math.ceil(abs(angle) / TURN_STEP_RAD)
    return [(x, y, begin + angle * k / count) for k in range(count)]


def _drive(leg: Leg) -> Iterator[tuple[Pose, int]]:
    curve, knots, piece = leg.curve, leg.curve.knot_s, 0
    back = math.pi if leg.reverse else 0.0
    count = max(2, math.ceil(curve.length_m / STEP_M))
    for k in range(count + 1):
        s = curve.length_m * k / count
        while piece < len(knots) - 2 and s > knots[piece + 1]:
            piece += 1
        yield (*curve.point_at(s), curve.heading_at(s) + back), leg.first + piece + 1
