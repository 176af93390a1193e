# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a map of a course or of a run shows, in the frame `world`, whoever draws it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
import math

import numpy as np
import numpy.typing as npt

from husky_grader.scoring.alignment import spread
from husky_course.route import Point, Route
from husky_course.route import Point, Route
from husky_course.outline import Outline
from husky_course.record import RunRecord
from husky_grader.scoring.scoring import Report

Array = npt.NDArray[np.float64]

MAX_POINTS = 1500
MARGIN_M = 0.8
NEAR_M = 1.5  # around a course
MIN_SIZE_M = 8.0


@dataclass(frozen=True)
class Scene:
    """Everything on a map; lines are lists of points in metres."""

    title: str
    obstacles: tuple[Outline, ...]
    given: list[Point]
    waypoints: list[Point]
    tolerance_m: float
    start: tuple[float, float, float]
    true: list[Point]
    believed: list[Point]
    marks: list[Point]  # collisions, or waypoints too near to something
    missed: frozenset[int] = frozenset()  # numbers of waypoints
    error: list[Point] = field(default_factory=list)  # outline of what lies between two paths

    def near_bounds(self) -> tuple[float, float, float, float]:
        """Return the same for the course and what was driven, not less than MIN_SIZE_M wide."""
        points = [*self.given, *self.true, *self.believed, *self.marks, self.start[:2]]
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        return (*_widened(min(xs), max(xs)), *_widened(min(ys), max(ys)))

    def bounds(self) -> tuple[float, float, float, float]:
        """Return the least and greatest x and y, with a margin."""
        points = [*self.given, *self.true, *(self.start[:2],)]
        for outline in self.obstacles:
            points += corners(outline)
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        return min(xs) - MARGIN_M, max(xs) + MARGIN_M, min(ys) - MARGIN_M, max(ys) + MARGIN_M


def _widened(low: float, high: float) -> tuple[float, float]:
    more = max(NEAR_M, (MIN_SIZE_M - (high - low)) / 2)
    return low - more, high + more


def corners(outline: Outline) -> list[Point]:
    """Return the corners of a rectangle, or of a polygon around a circle."""
    if outline.type == 'circle':
        (radius,) = outline.size
        turns = [k * math.pi / 12 for k in range(24)]
        return [
            (outline.x + radius * math.cos(a), outline.y + radius * math.sin(a)) for a in turns
        ]
    lx, ly = outline.size[0] / 2, outline.size[1] / 2
    cos, sin = math.cos(outline.yaw), math.sin(outline.yaw)
    return [
        (outline.x + cos * x - sin * y, outline.y + sin * x + cos * y)
        for x, y in ((lx, ly), (-lx, ly), (-lx, -ly), (lx, -ly))
    ]


def thinned(points: Sequence[Point]) -> list[Point]:
    """Leave points out where there are too many to see."""
    every = max(1, -(-len(points) // MAX_POINTS))
    return [*points[:-1:every], points[-1]] if points else []


def course_scene(
    route: Route,
    obstacles: tuple[Outline, ...],
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    marks: Sequence[Point] = (),
) -> Scene:
    """Return the map of a course nobody has driven yet."""
    x0, y0, yaw0 = start
    cos, sin = math.cos(yaw0), math.sin(yaw0)

    def to_world(x: float, y: float) -> Point:
        return x0 + cos * x - sin * y, y0 + sin * x + cos * y

    course = route.course
    return Scene(
        title=course.name,
        obstacles=obstacles,
        given=thinned([to_world(x, y) for x, y in zip(route.curve.x, route.curve.y, strict=True)]),
        waypoints=[to_world(point.x_m, point.y_m) for point in course.waypoints],
        tolerance_m=course.tolerance_m,
        start=start,
        true=[],
        believed=[],
        marks=list(marks),
    )


def run_scene(run: RunRecord, route: Route, report: Report) -> Scene:
    """Return the map of a run that was judged."""
    scene = course_scene(route, run.obstacles, run.start)
    seen = spread(run.x, run.y, MAX_POINTS)
    driven = slice(report.begin, report.end + 1)
    beside = spread(run.x[driven], run.y[driven], MAX_POINTS) + report.begin
    asked = np.array([route.curve.point_at(along) for along in report.along_m[beside]])
    missed = [i for i, got in enumerate(report.visits) if not got]  # a loop's last is its first
    return replace(
        scene,
        true=_points(*run.to_world(run.x[seen], run.y[seen])),
        believed=_points(*run.to_world(run.odom_x[seen], run.odom_y[seen])),
        marks=[touch.position[:2] for touch in run.collisions],
        missed=frozenset(i % len(route.course.waypoints) for i in missed),
        error=[
            *_points(*run.to_world(run.x[beside], run.y[beside])),
            *_points(*run.to_world(asked[:, 0], asked[:, 1]))[::-1],
        ],
    )


def _points(x: Array, y: Array) -> list[Point]:
    return list(zip(x.tolist(), y.tolist(), strict=True))
