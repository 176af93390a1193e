# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The picture that pens draw, pixel by pixel; turtles and background are not in it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from turtlesim_programs.motion import Colour, Line, PIXELS, PIXELS_PER_M, Point, SIDE_M

NOTHING = 0x00FFFFFF
"""A pixel that nobody has drawn upon: white that cannot be seen, as upstream has it."""

_OPAQUE = 0xFF000000
_THIN = 1

Pixels = NDArray[np.uint32]


def to_pixels(point: Point) -> Point:
    """Return a point in pixels; whole numbers are the middle of one, 0 is at the top left."""
    return point[0] * PIXELS_PER_M, (SIDE_M - point[1]) * PIXELS_PER_M


class Canvas:
    """A square of pixels, each 0xAARRGGBB, by row and column."""

    def __init__(self) -> None:
        self.pixels: Pixels = np.full((PIXELS, PIXELS), NOTHING, np.uint32)

    def clear(self) -> None:
        self.pixels[:] = NOTHING

    def colour_at(self, point: Point) -> Colour:
        """Return what is drawn there, in metres; white where nothing is."""
        column, row = (min(max(_rounded(value), 0), PIXELS - 1) for value in to_pixels(point))
        pixel = int(self.pixels[row, column])
        return pixel >> 16 & 0xFF, pixel >> 8 & 0xFF, pixel & 0xFF

    def draw(self, line: Line) -> None:
        """
        Draw a line without smooth edges.

        Of a wide one those pixels are drawn whose middle is inside its rectangle, which is longer
        than the line by half its width at each end, so that a way of many short lines has no gaps.
        A thin one has its ends and a pixel for each column, or for each row where it is steep.
        """
        start, end = _ordered(to_pixels(line.start), to_pixels(line.end))
        draw = self._draw_thin if line.pen.width == _THIN else self._draw_wide
        red, green, blue = line.pen.colour
        draw(start, end, line.pen.width, np.uint32(_OPAQUE | red << 16 | green << 8 | blue))

    def _draw_thin(self, start: Point, end: Point, width: int, value: np.uint32) -> None:
        is_steep = abs(end[1] - start[1]) > abs(end[0] - start[0])
        (a, across_a), (b, across_b) = (start[::-1], end[::-1]) if is_steep else (start, end)
        slope = (across_b - across_a) / (b - a) if b != a else 0.0
        columns = np.arange(*_inside(_rounded(min(a, b)), _rounded(max(a, b))))
        # The ends by themselves: a way of short lines has several in one column.
        along = np.append(columns, [a, b])
        across = np.append(across_a + (columns - a) * slope, [across_a, across_b])
        along, across = np.floor(along + 0.5), np.floor(across + 0.5)
        seen = (along >= 0) & (along < PIXELS) & (across >= 0) & (across < PIXELS)
        pixels = self.pixels.T if is_steep else self.pixels
        pixels[across[seen].astype(int), along[seen].astype(int)] = value

    def _draw_wide(self, start: Point, end: Point, width: int, value: np.uint32) -> None:
        (left, right), (top, bottom) = (
            _inside(math.floor(min(a, b)) - width, math.ceil(max(a, b)) + width)
            for a, b in zip(start, end, strict=True)
        )
        x = np.arange(left, right) - start[0]
        y = np.arange(top, bottom)[:, np.newaxis] - start[1]
        length = math.dist(start, end)
        cos, sin = (
            ((end[0] - start[0]) / length, (end[1] - start[1]) / length) if length else (1.0, 0.0)
        )
        along, across = x * cos + y * sin, y * cos - x * sin
        inside = (along >= -width / 2) & (along <= length + width / 2)
        # The one edge in and the other out: a line between two rows is as wide as any.
        inside &= (across > -width / 2) & (across <= width / 2)
        self.pixels[top:bottom, left:right][inside] = value


def _ordered(start: Point, end: Point) -> tuple[Point, Point]:
    """Return the left end first, of a steep line the lower: drawn back, it is the same."""
    right, down = end[0] - start[0], end[1] - start[1]
    is_forward = right > 0 if abs(right) >= abs(down) else down < 0
    return (start, end) if is_forward else (end, start)


def _inside(first: int, last: int) -> tuple[int, int]:
    """Return the part of a range that is in the picture, its end excluded."""
    begin = min(max(first, 0), PIXELS)
    return begin, max(begin, min(last + 1, PIXELS))


def _rounded(value: float) -> int:
    return math.floor(value + 0.5)
