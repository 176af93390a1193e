# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is drawn into the scene: trails, paths, waypoints, points and lidar hits."""

from collections.abc import Callable
import math
from typing import Any

from husky_course.frames import Array
import numpy as np
import numpy.typing as npt
import trimesh
import viser

from husky_view.picture.palette import Rgb

Colors = Rgb | npt.NDArray[np.uint8]

THICKNESS_PX = 3.0
TRAIL_STEP_M = 0.05
"""Points of a trail nearer than this to the one before are left out."""

PIECE_POINTS, MOST_PIECES = 100, 200
_NUMBER_ABOVE = np.array([0.0, 0.0, 0.05])  # of its disc, or the ground would hide its lower edge
_UPRIGHT = (1.0, 0.0, 0.0, 0.0)


def lifted(points: Array, height_m: float) -> Array:
    """Give points of the plane (n, 2) a height."""
    return np.column_stack([points, np.full(len(points), height_m)])


def _segments(points: Array) -> npt.NDArray[np.float32]:
    return np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)


def add_line(
    server: viser.ViserServer,
    name: str,
    points: Array,
    colors: Colors,
    *,
    thickness_px: float = THICKNESS_PX,
) -> viser.LineSegmentsHandle:
    """
    Draw a polyline (n, 3) in place of the one of this name.

    :param colors: one for all, or shape (n - 1, 2, 3): of both ends of each segment.
    """
    return server.scene.add_line_segments(
        name, _segments(points), colors, thickness=thickness_px, thickness_units='screen'
    )


class Trail:
    """
    A line that grows.

    The page gets a line whole whenever it changes. So a trail is cut into pieces: only the last
    one, which is short, is sent again. The oldest are removed.
    """

    def __init__(self, server: viser.ViserServer, name: str, color: Rgb) -> None:
        self._server = server
        self._name = name
        self._color = color
        self._pieces: list[viser.LineSegmentsHandle] = []
        self._points: list[tuple[float, float, float]] = []  # of the last piece
        self._drawn = 0  # points of the last piece
        self._made = 0

    def extend(self, points: Array) -> None:
        """Add points (n, 3), in order; `draw` shows them."""
        for x, y, z in points.tolist():
            if not self._points or math.dist(self._points[-1], (x, y, z)) >= TRAIL_STEP_M:
                self._points.append((x, y, z))
                if len(self._points) > PIECE_POINTS:
                    self.draw()
                    self._points = self._points[-1:]
                    self._drawn = 0

    @property
    def is_drawn(self) -> bool:
        """Tell whether there is anything to be seen of it."""
        return bool(self._pieces)

    def draw(self) -> None:
        """Send what is new."""
        if len(self._points) < 2 or len(self._points) == self._drawn:
            return
        points = np.array(self._points)
        if self._drawn >= 2:
            self._pieces[-1].points = _segments(points)
        else:
            if len(self._pieces) == MOST_PIECES:
                self._pieces.pop(0).remove()
            self._made += 1
            name = f'{self._name}/{self._made}'
            self._pieces.append(add_line(self._server, name, points, self._color))
        self._drawn = len(self._points)

    def clear(self) -> None:
        """Remove the whole line."""
        for piece in self._pieces:
            piece.remove()
        self._pieces.clear()
        self._points.clear()
        self._drawn = 0


class NumberedDiscs:
    """
    Numbered discs, some of them highlighted.

    :param on_drag: called on a thread of the server with the event of a drag.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        name: str,
        *,
        radius_m: float,
        height_m: float,
        color: Rgb,
        highlight: Rgb,
        on_drag: Callable[[Any], None] | None = None,
    ) -> None:
        self._scene = server.scene
        self._name = name
        self._shape = trimesh.creation.cylinder(radius=radius_m, height=height_m, sections=24)
        self._color, self._highlight = color, highlight
        self._on_drag = on_drag
        self._discs: list[Any] = []  # one handle for all of them, or none
        self._labels: list[Any] = []
        self._are_numbers_shown = True

    def show_numbers(self, shown: bool) -> None:
        """Show or hide the numbers; the discs stay."""
        self._are_numbers_shown = shown
        for label in self._labels:
            label.visible = shown

    def show(self, points: Array, *, highlighted: slice = slice(0), note: str = '') -> None:
        """
        Put a disc at each of the points (n, 3).

        :param note: what stands behind the numbers of those that are highlighted.
        """
        if len(points) != len(self._labels):
            for node in (*self._labels[len(points) :], *self._discs):
                node.remove()
            more = range(len(self._labels), len(points))
            self._labels[len(points) :] = [self._add_label(number + 1) for number in more]
            self._discs = [self._add_discs(points)] if len(points) else []
        for discs in self._discs:
            discs.batched_positions = points.astype(np.float32)
        noted = range(len(points))[highlighted]
        for place, (label, point) in enumerate(zip(self._labels, points, strict=True)):
            label.position = point + _NUMBER_ABOVE
            text = f'{place + 1}{note if place in noted else ""}'
            if label.text != text:
                label.text = text
        self.highlight(highlighted)

    def highlight(self, which: slice) -> None:
        """Highlight these discs and no others."""
        for discs in self._discs:
            discs.batched_colors = self._colors(which)

    def _colors(self, highlighted: slice) -> npt.NDArray[np.uint8]:
        colors = np.tile(np.array(self._color, dtype=np.uint8), (len(self._labels), 1))
        colors[highlighted] = self._highlight
        return colors

    def _add_label(self, number: int) -> Any:
        return self._scene.add_label(
            f'{self._name}/{number}',
            str(number),
            anchor='bottom-center',
            font_screen_scale=0.7,
            depth_test=True,
            visible=self._are_numbers_shown,
        )

    def _add_discs(self, points: Array) -> Any:
        discs = self._scene.add_batched_meshes_simple(
            f'{self._name}/discs',
            self._shape.vertices,
            self._shape.faces,
            batched_wxyzs=np.tile(_UPRIGHT, (len(points), 1)),
            batched_positions=points,
            batched_colors=self._colors(slice(0)),
            lod='off',
            cast_shadow=False,
        )
        if self._on_drag is not None:
            on_drag = self._on_drag

            @discs.on_drag
            async def _(event: Any) -> None:  # a coroutine: drags come in order
                on_drag(event)

        return discs
