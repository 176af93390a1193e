# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The head of an arrow."""

from __future__ import annotations

import math

from rqt_graph.layout import PlacedArrow, Point

HEAD_LENGTH = 11.0  # points
HEAD_HALF_WIDTH = 4.2


def arrow_head(arrow: PlacedArrow) -> tuple[Point, Point, Point]:
    """Return the triangle from the end of the curve to the arrow's tip."""
    (end_x, end_y), (tip_x, tip_y) = arrow.curve[-1], arrow.tip
    length = math.hypot(tip_x - end_x, tip_y - end_y) or 1.0
    along_x, along_y = (tip_x - end_x) / length, (tip_y - end_y) / length
    base_x, base_y = tip_x - HEAD_LENGTH * along_x, tip_y - HEAD_LENGTH * along_y
    side_x, side_y = -along_y * HEAD_HALF_WIDTH, along_x * HEAD_HALF_WIDTH
    return (
        arrow.tip,
        (base_x + side_x, base_y + side_y),
        (base_x - side_x, base_y - side_y),
    )
