# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Draw maps and curves as SVG text that a page can hold."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from husky_driver.path import Point
from husky_driver.scene import corners, Scene

PLOT_WIDTH, PLOT_HEIGHT = 480, 170
LEFT, RIGHT, TOP, BOTTOM = 48, 12, 10, 28

Series = tuple[str, Sequence[float]]  # CSS class and values


def map_svg(scene: Scene) -> str:
    """Return the map; one metre is 40 units, y upwards."""
    low_x, high_x, low_y, high_y = scene.bounds()
    scale = 40.0

    def at(point: Point) -> str:
        return f'{(point[0] - low_x) * scale:.1f},{(high_y - point[1]) * scale:.1f}'

    def line(points: Sequence[Point], css: str, **more: object) -> str:
        extra = ''.join(f' {name.replace("_", "-")}="{value}"' for name, value in more.items())
        path = ' '.join(at(point) for point in points)
        return f'<polyline class="{css}" points="{path}"{extra}/>' if points else ''

    def spot(point: Point, css: str, radius: float) -> str:
        x, y = at(point).split(',')
        return f'<circle class="{css}" cx="{x}" cy="{y}" r="{radius:.1f}"/>'

    parts = [
        f'<polygon class="obstacle" points="{" ".join(at(p) for p in corners(outline))}">'
        f'<title>{escape(outline.name)}</title></polygon>'
        for outline in scene.obstacles
    ]
    parts.append(line(scene.given, 'band', stroke_width=f'{2 * scene.tolerance_m * scale:.1f}'))
    parts += [spot(point, 'waypoint', 5) for point in scene.waypoints]
    parts.append(line(scene.given, 'given'))
    parts.append(line(scene.believed, 'believed'))
    parts.append(line(scene.true, 'true'))
    parts += [spot(point, 'mark', 11) for point in scene.marks]
    parts.append(spot(scene.start[:2], 'start', 7))
    width, height = (high_x - low_x) * scale, (high_y - low_y) * scale
    return (
        f'<svg class="map" viewBox="0 0 {width:.0f} {height:.0f}" role="img" '
        f'aria-label="map">{"".join(parts)}</svg>'
    )


def plot_svg(times: Sequence[float], series: Sequence[Series], unit: str) -> str:
    """Return curves over time with a labelled frame."""
    every = max(1, len(times) // 700)
    times = times[::every]
    values = [(css, list(line[::every])) for css, line in series]
    top = max((value for _, line in values for value in line), default=0.0)
    low = min((value for _, line in values for value in line), default=0.0)
    top, low = max(top, 0.05), min(low, 0.0)
    begin, span = times[0], max(times[-1] - times[0], 1e-9)

    def x(time: float) -> float:
        return LEFT + (time - begin) / span * (PLOT_WIDTH - LEFT - RIGHT)

    def y(value: float) -> float:
        return TOP + (top - value) / (top - low) * (PLOT_HEIGHT - TOP - BOTTOM)

    parts = [
        f'<line class="grid" x1="{LEFT}" x2="{PLOT_WIDTH - RIGHT}" y1="{y(v):.1f}" '
        f'y2="{y(v):.1f}"/><text x="{LEFT - 6}" y="{y(v) + 4:.1f}" text-anchor="end">'
        f'{v:.2f}</text>'
        for v in _ticks(low, top)
    ]
    parts += [
        f'<text x="{x(begin + span * k / 4):.1f}" y="{PLOT_HEIGHT - 8}" '
        f'text-anchor="{"end" if k == 4 else "middle"}">'
        f'{begin + span * k / 4:.1f}</text>'
        for k in range(5)
    ]
    for css, line in values:
        points = ' '.join(f'{x(t):.1f},{y(v):.1f}' for t, v in zip(times, line, strict=True))
        parts.append(f'<polyline class="{css}" points="{points}"/>')
    return (
        f'<svg class="plot" viewBox="0 0 {PLOT_WIDTH} {PLOT_HEIGHT}" role="img" '
        f'aria-label="{escape(unit)} over time">{"".join(parts)}</svg>'
    )


def _ticks(low: float, top: float) -> list[float]:
    """Return values to label: zero and both ends, unless they would overlap, and the middle."""
    ticks: list[float] = []
    for value in (0.0, top, low, (top + low) / 2):
        if all(abs(value - other) > 0.12 * (top - low) for other in ticks):
            ticks.append(value)
    return ticks
