# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Lines that grow.

A line of the page is sent whole whenever it changes. So a trail is cut into pieces, and only the
last one, still short, is sent again; the oldest are dropped at the end.
"""

import math

import numpy as np
import numpy.typing as npt
import viser

from husky_view.picture.palette import Rgb

STEP_M = 0.05
"""Points nearer than this to the one before are left out."""

PIECE = 100
PIECES = 200
THICKNESS_PX = 3.0

Array = npt.NDArray[np.float64]


def segments(points: Array) -> npt.NDArray[np.float32]:
    """Make the segments (n - 1, 2, 3) of a polyline (n, 3)."""
    return np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)


class Trail:
    """Where something has been."""

    def __init__(self, server: viser.ViserServer, name: str, color: Rgb) -> None:
        self._server = server
        self._name = name
        self._color = color
        self._pieces: list[viser.LineSegmentsHandle] = []
        self._points: list[tuple[float, float, float]] = []  # of the last piece
        self._drawn = 0
        self._made = 0

    def extend(self, points: Array) -> None:
        """Add points (n, 3), in order; `draw` shows them."""
        for x, y, z in points.tolist():
            if not self._points or math.dist(self._points[-1], (x, y, z)) >= STEP_M:
                self._points.append((x, y, z))
                if len(self._points) > PIECE:
                    self.draw()
                    self._points = self._points[-1:]
                    self._drawn = 0

    def draw(self) -> None:
        """Send what is new."""
        if len(self._points) < 2 or len(self._points) == self._drawn:
            return
        lines = segments(np.array(self._points))
        if self._drawn >= 2:
            self._pieces[-1].points = lines
        else:
            self._pieces.append(self._new_piece(lines))
        self._drawn = len(self._points)

    def _new_piece(self, lines: npt.NDArray[np.float32]) -> viser.LineSegmentsHandle:
        if len(self._pieces) == PIECES:
            self._pieces.pop(0).remove()
        self._made += 1
        return self._server.scene.add_line_segments(
            f'{self._name}/{self._made}',
            lines,
            self._color,
            thickness=THICKNESS_PX,
            thickness_units='screen',
        )

    def clear(self) -> None:
        """Begin anew."""
        for piece in self._pieces:
            piece.remove()
        self._pieces.clear()
        self._points.clear()
        self._drawn = 0
