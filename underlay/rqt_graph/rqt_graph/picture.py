# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Draw by Graphviz's `dot`, as rqt_graph does; pygraphviz's wheel contains it.

In the SVG the group of a shape has the shape's key as id, that of an arrow 'START>END'; a note is
the title of the link inside the group.
"""

from __future__ import annotations

from collections import Counter
import functools
import html
import os
from typing import Any

from ros2cli.errors import CommandError

from rqt_graph.selection import Drawing, Kind, Shape

EMPTY = 'No nodes are running in this domain.'
_PIXELS_PER_INCH = 144
_INK, _SOFT = '#16202c', '#5b6878'
FAULTY = {'fillcolor': '#fde2e0', 'color': '#b3261e'}
NODE_LOOK = {
    'shape': 'ellipse',
    'style': 'filled',
    'fillcolor': '#dbe9fb',
    'color': '#2563ae',
}
_LOOKS = {
    Kind.NODE: NODE_LOOK,
    Kind.TOPIC: {
        'shape': 'box',
        'style': 'filled,rounded',
        'fillcolor': '#fdf1d3',
        'color': '#a87411',
    },
}


def draw_svg(drawing: Drawing) -> bytes:
    """Return an SVG document, which may also be put into a page."""
    return draw(_graph(drawing), 'svg')


def draw_png(drawing: Drawing) -> bytes:
    """Return a PNG file, two pixels a point."""
    return draw(_graph(drawing), 'png')


@functools.cache
def load_graphviz() -> Any:
    """Return the module pygraphviz.

    :raises CommandError: where the system lacks a library that its wheel counts on, as all of
        their kind do (PEP 513): GLib, libX11, libXext, libXrender.
    """
    try:
        import pygraphviz  # type: ignore[import-untyped]
    except ImportError as error:
        raise CommandError(
            f'Graphviz, which draws the picture, cannot be loaded ({error}): install what it '
            'needs (Ubuntu, Debian: sudo apt install libglib2.0-0 libxext6 libxrender1; Fedora: '
            'sudo dnf install glib2 libXext libXrender)'
        ) from error
    return pygraphviz


@functools.cache
def _load_fonts() -> None:
    """Let fontconfig read its files with stderr closed.

    The wheel's fontconfig is older than the files of many systems, and warns of each element in
    them that it does not know.
    """
    stderr, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        load_graphviz().AGraph('graph { a }').draw(format='svg', prog='dot')
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)
        os.close(nowhere)


def draw(graph: Any, picture_format: str) -> bytes:
    """Draw a graph of pygraphviz; in a PNG two pixels are a point."""
    _load_fonts()
    if picture_format == 'png':
        graph.graph_attr['dpi'] = str(_PIXELS_PER_INCH)
    picture: bytes = graph.draw(format=picture_format, prog='dot')
    return picture


def draw_text(text: str, picture_format: str) -> bytes:
    """Draw what is written in Graphviz's language."""
    return draw(load_graphviz().AGraph(string=text), picture_format)


def empty_graph(empty: str, *, direction: str) -> Any:
    """Return a graph without shapes, in the look of all.

    :param empty: what to say as long as nothing is in it; '' once something is.
    :param direction: LR: from left to right; TB: from the top down.
    """
    graph = load_graphviz().AGraph(
        directed=True,
        rankdir=direction,
        nodesep='0.35',
        ranksep='0.65',
        outputorder='nodesfirst',
        bgcolor='white',
        pad='0.25',
    )
    font = {'fontname': 'DejaVu Sans,Verdana,Noto Sans,sans-serif', 'fontsize': '14'}
    graph.node_attr.update(**font, fontcolor=_INK, penwidth='1.5', height='0.53', width='1.1')
    graph.edge_attr.update(**font, fontcolor=_SOFT, color=_SOFT, penwidth='1.5', arrowsize='0.9')
    if empty:
        graph.add_node('empty', label=empty, shape='plaintext', fontcolor=_SOFT)
    return graph


def as_text(words: str) -> str:
    """Return what Graphviz draws as these words: in names from others it would see HTML and codes.

    HTML of theirs would have links, and a page holds the picture.
    """
    return html.escape(words).replace('\\', '\\\\')


def _graph(drawing: Drawing) -> Any:
    """Put the graph together; the same drawing always in the same way."""
    graph = empty_graph('' if drawing.shapes else EMPTY, direction='LR')
    for shape in drawing.shapes:
        graph.add_node(shape.key, **_attributes(shape))
    for arrow in drawing.arrows:
        note = ' to '.join(key.partition(':')[2] for key in (arrow.start, arrow.end))
        arrow_id = as_text(f'{arrow.start}>{arrow.end}')
        graph.add_edge(arrow.start, arrow.end, id=arrow_id, tooltip=as_text(note))
    counts = Counter(shape.namespace for shape in drawing.shapes)
    for number, namespace in enumerate(sorted(n for n in counts if n and counts[n] > 1)):
        graph.add_subgraph(
            [shape.key for shape in drawing.shapes if shape.namespace == namespace],
            f'cluster_{number}',
            tooltip=as_text(f'namespace {namespace}'),
            margin='14',
            style='filled,rounded,dashed',
            fillcolor='#f6f8fa',
            color='#c3ccd6',
        )
    return graph


def _attributes(shape: Shape) -> dict[str, str]:
    look = _LOOKS[shape.kind] | (FAULTY if shape.faulty else {})
    names = ['topic'] * (shape.kind is Kind.TOPIC) + ['faulty'] * shape.faulty
    return {
        **look,
        'label': as_text(shape.name),
        'id': as_text(shape.key),
        'class': ' '.join(names),  # behind 'node', as Graphviz calls every shape
        'tooltip': as_text(shape.note),
    }
