# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What an edited course looks like: discs to drag, and its path in the colours of clearance."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh
import viser

from husky_view.editor.course import Preview
from husky_view.picture import palette
from husky_view.picture.marks import lifted
from husky_view.picture.trail import segments

Array = npt.NDArray[np.float64]

DISC_RADIUS_M = 0.18
ENOUGH_M, SCARCE_M = 0.30, 0.15
"""Clearances: from here on comfortable, and from here on what a good drive needs."""

_UPRIGHT = (1.0, 0.0, 0.0, 0.0)


def clearance_color(clearance_m: float) -> palette.Rgb:
    """Return the colour of a place on the path."""
    if clearance_m >= ENOUGH_M:
        return palette.CLEAR
    return palette.SCARCE if clearance_m >= SCARCE_M else palette.BLOCKED


class EditorMarks:
    """
    Draws the course that is edited.

    :param on_drag: called on a thread of the server with the event of a drag.
    """

    def __init__(self, server: viser.ViserServer, on_drag: Callable[[Any], None]) -> None:
        self._server = server
        self._on_drag = on_drag
        self._discs: Any = None
        self._labels: list[Any] = []
        self._line: Any = None

    def show_points(self, points: Array, selected: int | None) -> None:
        """Put discs and numbers at points (n, 3)."""
        if len(points) != len(self._labels):
            self._make(points)
        if self._discs is None:
            return
        self._discs.batched_positions = points.astype(np.float32)
        self._discs.batched_colors = self._colors(len(points), selected)
        for label, point in zip(self._labels, points, strict=True):
            label.position = point

    def _make(self, points: Array) -> None:
        for node in [*self._labels, *([self._discs] if self._discs is not None else [])]:
            node.remove()
        self._discs, self._labels = None, []
        if not len(points):
            return
        disc = trimesh.creation.cylinder(radius=DISC_RADIUS_M, height=0.03, sections=24)
        self._discs = self._server.scene.add_batched_meshes_simple(
            '/editor/discs',
            disc.vertices,
            disc.faces,
            batched_wxyzs=np.tile(_UPRIGHT, (len(points), 1)),
            batched_positions=points,
            batched_colors=self._colors(len(points), None),
            lod='off',
            cast_shadow=False,
        )

        @self._discs.on_drag
        async def _(event: Any) -> None:
            self._on_drag(event)

        self._labels = [
            self._server.scene.add_label(
                f'/editor/{number}',
                str(number + 1),
                position=tuple(point),
                anchor='center-center',
                font_screen_scale=0.7,
            )
            for number, point in enumerate(points.tolist())
        ]

    def _colors(self, count: int, selected: int | None) -> npt.NDArray[np.uint8]:
        colors = np.tile(np.array(palette.EDITED, dtype=np.uint8), (count, 1))
        if selected is not None:
            colors[selected] = palette.SELECTED
        return colors

    def show_path(self, preview: Preview | None, height_m: float) -> None:
        """Draw the path; None clears it."""
        if self._line is not None:
            self._line.remove()
            self._line = None
        if preview is None or len(preview.line) < 2:
            return
        colors = np.array([clearance_color(float(c)) for c in preview.clearance_m], dtype=np.uint8)
        self._line = self._server.scene.add_line_segments(
            '/editor/path',
            segments(lifted(preview.line, height_m)),
            np.stack([colors[:-1], colors[1:]], axis=1),
            thickness=4.0,
            thickness_units='screen',
        )

    def clear(self) -> None:
        """Take everything away."""
        self.show_points(np.zeros((0, 3)), None)
        self.show_path(None, 0.0)
