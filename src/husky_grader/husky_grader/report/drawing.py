# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Metres on a drawing: the scale, and the axes around it."""

from collections.abc import Iterator, Sequence
import math

from husky_course.route import Point

from husky_grader.report.plot import ticks

SIZE = 1000.0  # the longer side, in units of the drawing
LEFT, RIGHT, TOP, BOTTOM = 90.0, 20.0, 20.0, 75.0
"""What axes take around a drawing."""

SHORTEST_BAR = 30.0

Bounds = tuple[float, float, float, float]
"""Least and greatest x and y, in metres."""


class Drawing:
    """Scales metres to units of the drawing, y upwards."""

    def __init__(self, bounds: Bounds) -> None:
        self.bounds = bounds
        low_x, high_x, low_y, high_y = bounds
        self.scale = SIZE / max(high_x - low_x, high_y - low_y)
        self.width, self.height = self.at((high_x, low_y))

    def at(self, point: Sequence[float]) -> Point:
        low_x, _, _, high_y = self.bounds
        return (point[0] - low_x) * self.scale, (high_y - point[1]) * self.scale


def axes(drawing: Drawing, frame: str) -> Iterator[str]:
    """
    Yield a grid in metres with its numbers.

    :param frame: that the numbers are in; empty if that goes without saying.
    """
    low_x, high_x, low_y, high_y = drawing.bounds
    width, height = drawing.width, drawing.height
    of = f' of {frame}' if frame else ''
    for value in _within(low_x, high_x):
        x, _ = drawing.at((value, 0.0))
        yield f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="0" y2="{height:.1f}"/>'
        yield f'<text class="x axis" x="{x:.1f}" y="{height + 28:.1f}">{value:g}</text>'
    for value in _within(low_y, high_y):
        _, y = drawing.at((0.0, value))
        yield f'<line class="grid" x1="0" x2="{width:.1f}" y1="{y:.1f}" y2="{y:.1f}"/>'
        yield f'<text class="y axis" x="-12" y="{y + 7:.1f}">{value:g}</text>'
    yield f'<text class="x axis" x="{width / 2:.1f}" y="{height + 58:.1f}">x{of} [m]</text>'
    turned = f'transform="rotate(-90 -62 {height / 2:.1f})"'
    yield f'<text class="x axis" x="-62" y="{height / 2:.1f}" {turned}>y{of} [m]</text>'


def _within(low: float, high: float) -> list[float]:
    return [value for value in ticks(low, high) if low < value < high]


def scale_bar(drawing: Drawing) -> Iterator[str]:
    """Yield a bar of 1 m, or of 10 m and so on where that could not be seen."""
    length_m = 10.0 ** max(0, math.ceil(math.log10(SHORTEST_BAR / drawing.scale)))
    end, y = drawing.width - 20.0, drawing.height - 20.0
    begin = end - length_m * drawing.scale
    yield f'<path class="bar" d="M{begin:.1f} {y - 8:.1f}v8H{end:.1f}v-8"/>'
    yield f'<text class="x axis" x="{(begin + end) / 2:.1f}" y="{y - 10:.1f}">{length_m:g} m</text>'
