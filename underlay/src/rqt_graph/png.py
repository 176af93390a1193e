# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Draw a layout as PNG, with neither a display nor fonts of the machine."""

from __future__ import annotations

import io

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, FancyBboxPatch, PathPatch, Polygon
from matplotlib.path import Path

from rqt_graph import style
from rqt_graph.geometry import arrow_head
from rqt_graph.layout import FONT_SIZE, Layout, PlacedArrow, PlacedShape
from rqt_graph.selection import Kind

_POINTS_PER_INCH = 72.0
_PIXELS_PER_INCH = 144


def draw_png(layout: Layout) -> bytes:
    """Return a PNG file, two pixels a point."""
    width, height = layout.width, layout.height
    if not layout.shapes:
        width, height = 420.0, 90.0
    figure = Figure(figsize=(width / _POINTS_PER_INCH, height / _POINTS_PER_INCH))
    figure.patch.set_facecolor(style.BACKGROUND)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(0, width)
    axes.set_ylim(height, 0)
    for cluster in layout.clusters:
        (x, y), (right, bottom) = cluster.low, cluster.high
        axes.add_patch(
            _box(x, y, right - x, bottom - y, 8.0, style.CLUSTER_FILL, style.CLUSTER_EDGE)
        )
    for arrow in layout.arrows:
        axes.add_patch(_curve(arrow))
        axes.add_patch(Polygon(arrow_head(arrow), facecolor=style.ARROW, edgecolor='none'))
    for placed in layout.shapes:
        axes.add_patch(_outline(placed))
        _write(axes, placed.center, placed.shape.name, style.TEXT)
    if not layout.shapes:
        _write(axes, (width / 2, height / 2), style.EMPTY, style.CLUSTER_TEXT)
    output = io.BytesIO()
    FigureCanvasAgg(figure).print_figure(output, format='png', dpi=_PIXELS_PER_INCH)
    return output.getvalue()


def _outline(placed: PlacedShape) -> Ellipse | FancyBboxPatch:
    (x, y), colours = placed.center, style.paint(placed.shape)
    if placed.shape.kind is Kind.NODE:
        return Ellipse(
            (x, y),
            placed.width,
            placed.height,
            facecolor=colours.fill,
            edgecolor=colours.edge,
            linewidth=1.5,
        )
    left, top = x - placed.width / 2, y - placed.height / 2
    return _box(left, top, placed.width, placed.height, 3.0, colours.fill, colours.edge)


def _box(
    x: float, y: float, width: float, height: float, radius: float, fill: str, edge: str
) -> FancyBboxPatch:
    return FancyBboxPatch(
        (x, y),
        width,
        height,
        boxstyle=f'round,pad=0,rounding_size={radius}',
        facecolor=fill,
        edgecolor=edge,
        linewidth=1.5 if radius < 5.0 else 1.0,
        linestyle='-' if radius < 5.0 else '--',
    )


def _curve(arrow: PlacedArrow) -> PathPatch:
    codes = [Path.MOVETO] + [Path.CURVE4] * (len(arrow.curve) - 1)
    return PathPatch(
        Path(arrow.curve, codes), facecolor='none', edgecolor=style.ARROW, linewidth=1.5
    )


def _write(axes: object, center: tuple[float, float], text: str, colour: str) -> None:
    axes.text(  # type: ignore[attr-defined]
        *center,
        text,
        ha='center',
        va='center_baseline',
        fontsize=FONT_SIZE,
        color=colour,
        family='DejaVu Sans',
        parse_math=False,
    )
