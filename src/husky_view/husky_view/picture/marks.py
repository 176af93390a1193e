# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Marks on the ground: the given path, its waypoints, the look-ahead point, lidar hits."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh
import viser

from husky_view.picture import palette
from husky_view.picture.trail import segments, THICKNESS_PX

Array = npt.NDArray[np.float64]

DISC_RADIUS_M = 0.12
_UPRIGHT = (1.0, 0.0, 0.0, 0.0)


def lifted(points: Array, height_m: float) -> Array:
    """Give points of the plane (n, 2) a height."""
    return np.column_stack([points, np.full(len(points), height_m)])


class PathMark:
    """The path that a robot is to follow."""

    def __init__(self, server: viser.ViserServer, name: str) -> None:
        self._server = server
        self._name = name
        self._line: Any = None

    def show(self, points: Array) -> None:
        """Draw a line through points (n, 3); fewer than two clear it."""
        if self._line is not None:
            self._line.remove()
            self._line = None
        if len(points) >= 2:
            self._line = self._server.scene.add_line_segments(
                self._name,
                segments(points),
                palette.PATH,
                thickness=THICKNESS_PX,
                thickness_units='screen',
            )


class WaypointMarks:
    """Numbered discs; those reached change their colour."""

    def __init__(self, server: viser.ViserServer, name: str) -> None:
        self._server = server
        self._name = name
        self._nodes: list[Any] = []
        self._discs: Any = None
        self._count = 0

    def show(self, points: Array, *, reached: int = 0) -> None:
        """Put a disc at each of the points (n, 3)."""
        self.clear()
        self._count = len(points)
        if not self._count:
            return
        disc = trimesh.creation.cylinder(radius=DISC_RADIUS_M, height=0.01, sections=24)
        self._discs = self._server.scene.add_batched_meshes_simple(
            f'{self._name}/discs',
            disc.vertices,
            disc.faces,
            batched_wxyzs=np.tile(_UPRIGHT, (self._count, 1)),
            batched_positions=points,
            batched_colors=self._colors(reached),
            lod='off',
            cast_shadow=False,
        )
        self._nodes = [self._discs] + [
            self._server.scene.add_label(
                f'{self._name}/{number}',
                str(number + 1),
                position=(float(x), float(y), float(z)),
                anchor='center-center',
                font_screen_scale=0.7,
            )
            for number, (x, y, z) in enumerate(points)
        ]

    def set_reached(self, reached: int) -> None:
        """Colour the first so many discs as reached."""
        if self._discs is not None:
            self._discs.batched_colors = self._colors(reached)

    def _colors(self, reached: int) -> npt.NDArray[np.uint8]:
        colors = np.tile(np.array(palette.WAYPOINT, dtype=np.uint8), (self._count, 1))
        colors[:reached] = palette.REACHED
        return colors

    def clear(self) -> None:
        """Take all of them away."""
        for node in self._nodes:
            node.remove()
        self._nodes.clear()
        self._discs = None


class PointMark:
    """A ball at one place, hidden until it is put somewhere."""

    def __init__(self, server: viser.ViserServer, name: str, color: palette.Rgb) -> None:
        self._ball = server.scene.add_icosphere(
            name, radius=0.09, color=color, visible=False, cast_shadow=False
        )

    def show(self, position: Sequence[float] | None) -> None:
        """Put it there; None hides it."""
        if position is not None:
            self._ball.position = np.asarray(position)
        self._ball.visible = position is not None


class LidarMark:
    """The places that the beams of a lidar hit."""

    def __init__(self, server: viser.ViserServer, name: str) -> None:
        self._cloud = server.scene.add_point_cloud(
            name,
            points=np.zeros((1, 3), dtype=np.float32),
            colors=palette.LIDAR,
            point_size=0.04,
            visible=False,
        )

    def show(self, points: Array) -> None:
        """Show hits (n, 3) in the world; none hide the cloud."""
        self._cloud.visible = len(points) > 0
        if len(points):
            self._cloud.points = points.astype(np.float32)
