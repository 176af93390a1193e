# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The names on a map of what is near the path."""

from collections.abc import Iterator, Sequence
from html import escape
import math

from husky_course.frames import Array
from husky_course.outline import Outline
from husky_course.printable import printable
from husky_course.route import Point
import numpy as np

from husky_grader.report.drawing import Drawing

NAMED_M, MAX_NAMES = 1.5, 12
LETTER = 10.0  # its width, in units of the drawing


def names(
    obstacles: Sequence[Outline], path: Sequence[Point], drawing: Drawing
) -> Iterator[str]:
    """Yield the names of the obstacles that are nearest to the path, each along its longer side."""
    points = np.array(path).reshape(-1, 2)
    away_m = {outline: _distance(outline, points) for outline in obstacles}
    for outline in sorted(away_m, key=away_m.__getitem__)[:MAX_NAMES]:
        if away_m[outline] > NAMED_M:
            return
        name = escape(printable(outline.name))
        x, y = drawing.at((outline.x, outline.y))
        turn = _turn(outline)
        if turn == 0.0:  # whole, also at the border
            half = LETTER * len(outline.name) / 2.0
            x = min(max(x, half), drawing.width - half)
        yield (
            f'<text class="name" x="{x:.1f}" y="{y:.1f}" '
            f'transform="rotate({turn:.1f} {x:.1f} {y:.1f})">{name}</text>'
        )


def _turn(outline: Outline) -> float:
    """Return how far the name is turned to the right, in degrees; never upside down."""
    if outline.type == 'circle':
        return 0.0
    is_upright = outline.size[1] > outline.size[0]
    turn = math.degrees(-outline.yaw) + (90.0 if is_upright else 0.0)
    return (turn + 90.0) % 180.0 - 90.0


def _distance(outline: Outline, points: Array) -> float:
    """Return how far the nearest of some points (n, 2) is from an outline."""
    if not len(points):
        return math.inf
    dx, dy = points[:, 0] - outline.x, points[:, 1] - outline.y
    if outline.type == 'circle':
        return max(0.0, float(np.hypot(dx, dy).min()) - outline.size[0])
    along, across = math.cos(outline.yaw), math.sin(outline.yaw)
    away_x = np.abs(dx * along + dy * across) - outline.size[0] / 2
    away_y = np.abs(dy * along - dx * across) - outline.size[1] / 2
    return float(np.hypot(np.maximum(away_x, 0.0), np.maximum(away_y, 0.0)).min())
