# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Place the shapes of a drawing, by Graphviz's `dot` as in rqt_graph."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
import json
from typing import Any

import pygraphviz  # type: ignore[import-untyped]

from rqt_graph.selection import Drawing, Kind, Shape

FONT_SIZE = 14.0  # points, as everything here
SHAPE_HEIGHT = 38.0
MARGIN = 18.0
_CLUSTER_MARGIN = 14.0
_POINTS_PER_INCH = 72.0
# Advance widths of DejaVu Sans (and of Verdana, which is cut alike) in em, by character.
_WIDTHS = {
    **dict.fromkeys("ijl'", 0.28),
    **dict.fromkeys('/.,:', 0.34),
    **dict.fromkeys('ftrIJ()', 0.38),
    **dict.fromkeys('csz_', 0.53),
    **dict.fromkeys('mMW@', 0.92),
    **dict.fromkeys('wADGHNOQU', 0.80),
}
_ORDINARY_WIDTH = 0.63

Point = tuple[float, float]


@dataclass(frozen=True)
class PlacedShape:
    shape: Shape
    center: Point
    width: float
    height: float


@dataclass(frozen=True)
class PlacedArrow:
    start: str
    end: str
    curve: tuple[Point, ...]  # Bézier: a point, then three for each piece
    tip: Point


@dataclass(frozen=True)
class Cluster:
    """The frame around what shares a namespace."""

    label: str
    low: Point
    high: Point


@dataclass(frozen=True)
class Layout:
    """Where everything is, in points from the upper left corner, y downwards."""

    width: float
    height: float
    shapes: tuple[PlacedShape, ...]
    arrows: tuple[PlacedArrow, ...]
    clusters: tuple[Cluster, ...]


def text_width(text: str, size: float = FONT_SIZE) -> float:
    """Return about how wide a text is; fonts of other machines are hardly wider."""
    return sum(_WIDTHS.get(character, _ORDINARY_WIDTH) for character in text) * size


def place(drawing: Drawing) -> Layout:
    """Place everything, from left to right; the same drawing always in the same way."""
    sizes = {shape.key: _width(shape) for shape in drawing.shapes}
    graph = _graphviz(drawing, sizes)
    placed = json.loads(graph.draw(format='json', prog='dot'))
    low_x, low_y, high_x, high_y = (float(value) for value in placed['bb'].split(','))

    def at(text: str) -> Point:
        x, y = (float(value) for value in text.split(','))
        return x - low_x + MARGIN, high_y - y + MARGIN

    objects: list[dict[str, Any]] = placed.get('objects', [])
    centers = {item['name']: at(item['pos']) for item in objects if 'pos' in item}
    names = {item['_gvid']: item['name'] for item in objects}
    return Layout(
        high_x - low_x + 2 * MARGIN,
        high_y - low_y + 2 * MARGIN,
        tuple(
            PlacedShape(shape, centers[shape.key], sizes[shape.key], SHAPE_HEIGHT)
            for shape in drawing.shapes
        ),
        tuple(_arrow(edge, names, at) for edge in placed.get('edges', [])),
        tuple(_cluster(item, at) for item in objects if 'bb' in item),
    )


def _width(shape: Shape) -> float:
    # Text fits an ellipse where its corners do, so that it needs more room than a box.
    padding = 48.0 if shape.kind is Kind.NODE else 26.0
    return max(text_width(shape.name) + padding, 80.0)


def _graphviz(drawing: Drawing, sizes: dict[str, float]) -> Any:
    graph = pygraphviz.AGraph(
        directed=True, rankdir='LR', nodesep='0.35', ranksep='0.65', outputorder='nodesfirst'
    )
    shapes = {Kind.NODE: 'ellipse', Kind.TOPIC: 'box'}
    for shape in drawing.shapes:
        graph.add_node(
            shape.key,
            label='',
            shape=shapes[shape.kind],
            fixedsize='true',
            width=str(sizes[shape.key] / _POINTS_PER_INCH),
            height=str(SHAPE_HEIGHT / _POINTS_PER_INCH),
        )
    for arrow in drawing.arrows:
        graph.add_edge(arrow.start, arrow.end)
    counts = Counter(shape.namespace for shape in drawing.shapes)
    for number, namespace in enumerate(sorted(n for n in counts if n and counts[n] > 1)):
        members = [shape.key for shape in drawing.shapes if shape.namespace == namespace]
        graph.add_subgraph(
            members, f'cluster_{number}', tooltip=namespace, margin=str(_CLUSTER_MARGIN)
        )
    return graph


def _arrow(edge: dict[str, Any], names: dict[int, str], at: Any) -> PlacedArrow:
    tip, *points = edge['pos'].removeprefix('e,').split(' ')
    return PlacedArrow(
        names[edge['tail']], names[edge['head']], tuple(at(point) for point in points), at(tip)
    )


def _cluster(item: dict[str, Any], at: Any) -> Cluster:
    left, bottom, right, top = item['bb'].split(',')
    return Cluster(item['tooltip'], at(f'{left},{top}'), at(f'{right},{bottom}'))
