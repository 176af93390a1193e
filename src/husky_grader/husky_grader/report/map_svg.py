# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Draw the map of a run as SVG text that a page can hold: the course and what stands near it."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from husky_course.printable import printable
from husky_course.route import Point
from husky_grader.report.map import corners, Scene

SIZE = 1000.0  # the longer side, in units of the drawing
DOT = 7.0
RAISED = 12.0  # a number beside its waypoint


def map_svg(scene: Scene) -> str:
    """Return the map, y upwards; lines keep their width on the screen, the band is to scale."""
    low_x, high_x, low_y, high_y = scene.near_bounds()
    scale = SIZE / max(high_x - low_x, high_y - low_y)

    def at(point: Point) -> tuple[float, float]:
        return (point[0] - low_x) * scale, (high_y - point[1]) * scale

    width, height = at((high_x, low_y))
    band_m = 2 * scene.tolerance_m
    parts = [
        *(
            _obstacle(outline.name, [at(p) for p in corners(outline)])
            for outline in scene.obstacles
        ),
        _line(
            'polyline',
            'band',
            [at(p) for p in scene.given],
            f'style="stroke-width: {band_m * scale:.1f}px"',
        ),
        _line('polyline', 'given', [at(p) for p in scene.given]),
        _line('polygon', 'error', [at(p) for p in scene.error]),
        _line('polyline', 'believed', [at(p) for p in scene.believed]),
        _line('polyline', 'true', [at(p) for p in scene.true]),
        _dot('start', at(scene.start[:2]), 1.6 * DOT),
    ]
    parts += [_waypoint(scene, number, at(point)) for number, point in enumerate(scene.waypoints)]
    parts += [
        _dot('mark', at(point), 2.2 * DOT) + _number('hit', number, at(point), 0.0)
        for number, point in enumerate(scene.marks)
    ]
    return (
        f'<svg class="map" viewBox="0 0 {width:.0f} {height:.0f}" role="img" '
        f'aria-label="map of the run">{"".join(parts)}</svg>'
    )


def _obstacle(name: str, points: Sequence[Point]) -> str:
    title = f'<title>{escape(printable(name))}</title>'
    return _line('polygon', 'obstacle', points).replace('/>', f'>{title}</polygon>')


def _line(kind: str, css: str, points: Sequence[Point], more: str = '') -> str:
    path = ' '.join(f'{x:.1f},{y:.1f}' for x, y in points)
    return f'<{kind} class="{css}" points="{path}" {more}/>' if points else ''


def _dot(css: str, place: Point, radius: float) -> str:
    return f'<circle class="{css}" cx="{place[0]:.1f}" cy="{place[1]:.1f}" r="{radius:.1f}"/>'


def _waypoint(scene: Scene, number: int, place: Point) -> str:
    css = 'missed' if number in scene.missed else 'waypoint'
    return _dot(css, place, DOT) + _number(css, number, place, RAISED)


def _number(css: str, number: int, place: Point, raised: float) -> str:
    x, y = place[0] + raised, place[1] - raised
    return f'<text class="{css}" x="{x:.1f}" y="{y:.1f}">{number + 1}</text>'
