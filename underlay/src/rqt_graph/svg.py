# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Draw a layout as SVG, which a browser shows and a page can bring to life."""

from __future__ import annotations

from html import escape

from rqt_graph import style
from rqt_graph.geometry import arrow_head
from rqt_graph.layout import Cluster, FONT_SIZE, Layout, PlacedArrow, PlacedShape, Point
from rqt_graph.selection import Kind


def draw_svg(layout: Layout) -> str:
    """Return a whole SVG document."""
    width, height = layout.width, layout.height
    parts = [
        *(_cluster(cluster) for cluster in layout.clusters),
        *(_arrow(arrow) for arrow in layout.arrows),
        *(_shape(shape) for shape in layout.shapes),
    ]
    if not layout.shapes:
        width, height = 420.0, 90.0
        parts = [_text(style.EMPTY, (width / 2, height / 2), style.CLUSTER_TEXT)]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.1f} {height:.1f}" role="img" aria-label="ROS graph" '
        f'font-family="{escape(style.FONTS)}">\n'
        f'<rect class="background" width="100%" height="100%" fill="{style.BACKGROUND}"/>\n'
        + '\n'.join(parts)
        + '\n</svg>\n'
    )


def _shape(placed: PlacedShape) -> str:
    (x, y), shape, colours = placed.center, placed.shape, style.paint(placed.shape)
    look = f'fill="{colours.fill}" stroke="{colours.edge}" stroke-width="1.5"'
    if shape.kind is Kind.NODE:
        outline = (
            f'<ellipse cx="{x:.1f}" cy="{y:.1f}" rx="{placed.width / 2:.1f}" '
            f'ry="{placed.height / 2:.1f}" {look}/>'
        )
    else:
        outline = (
            f'<rect x="{x - placed.width / 2:.1f}" y="{y - placed.height / 2:.1f}" '
            f'width="{placed.width:.1f}" height="{placed.height:.1f}" rx="3" {look}/>'
        )
    faulty = ' faulty' if shape.faulty else ''
    return (
        f'<g class="{shape.kind.value}{faulty}" data-key="{escape(shape.key)}">'
        f'<title>{escape(shape.note)}</title>{outline}{_text(shape.name, placed.center)}</g>'
    )


def _arrow(arrow: PlacedArrow) -> str:
    first, *rest = (_pair(point) for point in arrow.curve)
    head = ' '.join(_pair(point) for point in arrow_head(arrow))
    return (
        f'<g class="arrow" data-start="{escape(arrow.start)}" data-end="{escape(arrow.end)}">'
        f'<path d="M{first}C{" ".join(rest)}" fill="none" stroke="{style.ARROW}" '
        f'stroke-width="1.5"/><polygon points="{head}" fill="{style.ARROW}"/></g>'
    )


def _cluster(cluster: Cluster) -> str:
    (x, y), (right, bottom) = cluster.low, cluster.high
    return (
        f'<g class="namespace"><rect x="{x:.1f}" y="{y:.1f}" width="{right - x:.1f}" '
        f'height="{bottom - y:.1f}" rx="8" fill="{style.CLUSTER_FILL}" '
        f'stroke="{style.CLUSTER_EDGE}" stroke-dasharray="5 4"/>'
        f'<title>namespace {escape(cluster.label)}</title></g>'
    )


def _text(text: str, center: Point, colour: str = style.TEXT) -> str:
    # dominant-baseline is not everywhere: the middle of the letters is set by hand.
    return (
        f'<text x="{center[0]:.1f}" y="{center[1] + 0.36 * FONT_SIZE:.1f}" '
        f'text-anchor="middle" font-size="{FONT_SIZE:g}" fill="{colour}">{escape(text)}</text>'
    )


def _pair(point: Point) -> str:
    return f'{point[0]:.1f},{point[1]:.1f}'
