# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Coordinates on the ground, as a waypoint file has them: the frame odom of a robot."""

from collections.abc import Sequence
from html import escape
import json
import math
from typing import NamedTuple

from husky_course.outline import Outline
from husky_course.robot import RobotStart
import numpy as np
import viser

from husky_view.picture.geometry import Bounds, to_odom, to_world
from husky_view.picture.tabs import Tabs

AXIS_M = 1.0
X_COLOR, Y_COLOR = (220, 60, 60), (60, 190, 60)  # as in RViz
AXIS_PX, GRID_PX = 4.0, 1.5
GRID_M = 2.0
GRID_COLOR = (150, 150, 155)


def _at(start: RobotStart, x: float, y: float, height_m: float) -> tuple[float, float, float]:
    (place,) = to_world(start, np.array([[x, y]]))
    return float(place[0]), float(place[1]), height_m


def add_start_axes(
    server: viser.ViserServer, name: str, start: RobotStart, height_m: float
) -> None:
    """Draw the axes x and y where a robot starts, a metre long each."""
    ends = ((AXIS_M, 0.0), (0.0, AXIS_M))
    origin = _at(start, 0.0, 0.0, height_m)
    lines = np.array([[origin, _at(start, *end, height_m)] for end in ends], dtype=np.float32)
    colors = np.array([[color, color] for color in (X_COLOR, Y_COLOR)], dtype=np.uint8)
    server.scene.add_line_segments(
        f'{name}/lines', lines, colors, thickness=AXIS_PX, thickness_units='screen'
    )
    for word, end in zip(('x', 'y'), ends, strict=True):
        server.scene.add_label(
            f'{name}/{word}',
            word,
            position=_at(start, *end, height_m + 0.05),
            anchor='bottom-center',
            font_screen_scale=0.7,
            depth_test=True,
        )


class TopGrids:
    """
    A grid in each tab that looks down: lines every 2 m with their numbers.

    :param seen: what such a tab sees.
    """

    def __init__(self, tabs: Tabs, seen: Bounds, height_m: float) -> None:
        self._seen = seen
        self._height_m = height_m
        self._grids: dict[int, _Grid] = {}  # by client
        self._made = 0
        tabs.on_gone(lambda tab: self._grids.pop(tab, None))

    def show(self, client: viser.ClientHandle, start: RobotStart) -> None:
        """Show the grid of a robot in a tab, in place of another one's."""
        grid = self._grids.get(client.client_id)
        if grid is not None and grid.start != start:
            grid.nodes.remove()
        if grid is None or grid.start != start:
            # Under a new name: viser puts a label that was made anew in a wrong place.
            self._made += 1
            nodes = self._draw(client.scene, f'/grid{self._made}', start)
            self._grids[client.client_id] = grid = _Grid(client, start, nodes)
        grid.nodes.visible = True

    def hide(self, client: viser.ClientHandle) -> None:
        """Hide the grid in a tab; may be called twice."""
        grid = self._grids.get(client.client_id)
        if grid is not None:
            grid.nodes.visible = False

    def choose(self, start: RobotStart) -> None:
        """Show the grid of another robot where one is shown."""
        for grid in list(self._grids.values()):
            if grid.nodes.visible:
                self.show(grid.client, start)

    def _draw(self, scene: viser.SceneApi, name: str, start: RobotStart) -> viser.FrameHandle:
        nodes = scene.add_frame(name, show_axes=False)
        low_x, high_x, low_y, high_y = self._seen
        corners = np.array([(x, y) for x in (low_x, high_x) for y in (low_y, high_y)])
        low, high = to_odom(start, corners).min(axis=0), to_odom(start, corners).max(axis=0)
        lines = []
        for axis, word in enumerate('xy'):
            across = 1 - axis
            first = math.ceil(low[axis] / GRID_M)
            for number in range(first, math.floor(high[axis] / GRID_M) + 1):
                begin, end = np.empty(2), np.empty(2)
                begin[axis] = end[axis] = number * GRID_M
                begin[across], end[across] = low[across], high[across]
                lines.append(
                    [_at(start, each[0], each[1], self._height_m) for each in (begin, end)]
                )
                scene.add_label(
                    f'{name}/{word}{number}',
                    f'{word} {number * GRID_M:g}',
                    position=lines[-1][0],
                    anchor='center-center',
                    font_screen_scale=0.8,
                )
        scene.add_line_segments(
            f'{name}/lines',
            np.array(lines, dtype=np.float32),
            GRID_COLOR,
            thickness=GRID_PX,
            thickness_units='screen',
        )
        return nodes


class _Grid(NamedTuple):
    client: viser.ClientHandle
    start: RobotStart
    nodes: viser.FrameHandle  # the root of all


def ground_html(
    start: RobotStart, ground_m: float, outlines: Sequence[Outline], *, is_named: bool
) -> str:
    """
    Return what the script of the pointer knows of the ground.

    :param is_named: whether it is to tell of which robot the coordinates are.
    """
    ground = {
        'name': start.name if is_named else '',
        'frame': (start.x, start.y, start.yaw),
        'height': ground_m,
        'obstacles': [
            (each.name, *(round(part, 2) for part in (each.x, each.y, each.yaw, *each.size)))
            for each in outlines
        ],
    }
    return f'<div data-ground="{escape(json.dumps(ground))}"></div>'
