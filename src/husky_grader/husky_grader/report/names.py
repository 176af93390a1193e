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
LINE = 12.0  # half a line of letters, and a gap


def names(
    obstacles: Sequence[Outline], path: Sequence[Point], drawing: Drawing
) -> Iterator[str]:
    """
    Yield the names of the obstacles that are nearest to the path.

    Each lies along the longer side of its obstacle, or beneath one that is shorter than the name.
    Where two would lie over each other, the one that is nearer to the path is shown.
    """
    points = np.array(path).reshape(-1, 2)
    away_m = {outline: _distance(outline, points) for outline in obstacles}
    level: list[tuple[float, float, float]] = []  # of those that are not turned
    nearest: dict[str, Outline] = {}  # the part that is, of an obstacle with several
    for outline in sorted(away_m, key=away_m.__getitem__):
        nearest.setdefault(outline.name, outline)
    for outline in list(nearest.values())[:MAX_NAMES]:
        if away_m[outline] > NAMED_M:
            return
        length = LETTER * len(outline.name)
        x, y, turn = _place(outline, length, drawing)
        if turn == 0.0:
            if any(_overlap((x, y, length), other) for other in level):
                continue
            level.append((x, y, length))
        yield (
            f'<text class="name" x="{x:.1f}" y="{y:.1f}" '
            f'transform="rotate({turn:.1f} {x:.1f} {y:.1f})">{escape(printable(outline.name))}'
            '</text>'
        )


def _place(outline: Outline, length: float, drawing: Drawing) -> tuple[float, float, float]:
    """Return where the middle of a name lies, and how far it is turned, in degrees."""
    x, y = drawing.at((outline.x, outline.y))
    turn = 0.0
    if outline.type == 'rect' and length <= drawing.scale * max(outline.size):
        turn = _turn(outline)
    else:
        away = drawing.scale * _reach_m(outline) + LINE
        y += away if y + away + LINE <= drawing.height else -away
    if turn == 0.0:  # whole, also at the border
        x = min(max(x, length / 2.0), drawing.width - length / 2.0)
    return x, y, turn


def _overlap(name: tuple[float, float, float], other: tuple[float, float, float]) -> bool:
    """Tell whether two level names, of x, y and length, lie over each other."""
    (x, y, length), (other_x, other_y, other_length) = name, other
    return abs(x - other_x) < (length + other_length) / 2.0 and abs(y - other_y) < 2.0 * LINE


def _turn(outline: Outline) -> float:
    """Return how far a rectangle's name is turned to the right, in degrees; never upside down."""
    is_upright = outline.size[1] > outline.size[0]
    turn = math.degrees(-outline.yaw) + (90.0 if is_upright else 0.0)
    return (turn + 90.0) % 180.0 - 90.0


def _reach_m(outline: Outline) -> float:
    """Return how far an outline reaches towards -y of the frame `world` from its middle."""
    if outline.type == 'circle':
        return outline.size[0]
    length, width = outline.size
    return (abs(length * math.sin(outline.yaw)) + abs(width * math.cos(outline.yaw))) / 2.0


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
