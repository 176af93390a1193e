# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Draw a map as PNG or SVG with matplotlib, without a display."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon

from husky_course.printable import printable
from husky_course.route import Point
from husky_grader.report.map import corners, Scene

MAX_NUMBERS = 60  # more could not be read, and take time


def draw(scene: Scene, path: Path) -> None:
    """Write the map to a file; its ending tells the format."""
    figure = Figure(figsize=(7.0, 7.0), dpi=110)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.12, 0.08, 0.86, 0.87))
    for outline in scene.obstacles:
        axes.add_patch(Polygon(corners(outline), closed=True, color='#8a8f98', lw=0))
    for number, (x, y) in enumerate(scene.waypoints, 1):
        axes.add_patch(Circle((x, y), scene.tolerance_m, fill=False, color='#9db8d8', lw=0.8))
        if len(scene.waypoints) <= MAX_NUMBERS:
            beside = (x + scene.tolerance_m, y + scene.tolerance_m)
            axes.text(*beside, str(number), color='#1f5fa8', fontsize=7)
    _line(axes, scene.given, 'given path', color='#1f5fa8', lw=1.6)
    _line(axes, scene.believed, 'believed (odometry)', color='#c78a00', lw=1.0, ls='--')
    _line(axes, scene.true, 'true path', color='#2a8f4f', lw=1.4)
    _line(axes, scene.marks, 'touched', color='#d62728', marker='X', ls='', ms=9)
    axes.plot(*scene.start[:2], marker='o', color='black', ms=5, label='start')
    low_x, high_x, low_y, high_y = scene.bounds()
    axes.set(xlim=(low_x, high_x), ylim=(low_y, high_y), xlabel='x [m]', ylabel='y [m]')
    axes.set_title(printable(scene.title), parse_math=False)
    axes.set_aspect('equal')
    axes.grid(True, lw=0.3)
    axes.legend(loc='upper right', fontsize=7)
    figure.savefig(path)


def _line(axes: object, points: Sequence[Point], label: str, **style: object) -> None:
    if points:
        xs, ys = zip(*points, strict=True)
        axes.plot(xs, ys, label=label, **style)  # type: ignore[attr-defined]
