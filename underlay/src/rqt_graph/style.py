# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Colours of the picture, whatever it is drawn with."""

from __future__ import annotations

from dataclasses import dataclass

from rqt_graph.selection import Kind, Shape

BACKGROUND = '#ffffff'
TEXT = '#16202c'
ARROW = '#5b6878'
CLUSTER_EDGE, CLUSTER_FILL, CLUSTER_TEXT = '#c3ccd6', '#f6f8fa', '#5b6878'
FONTS = "'DejaVu Sans', Verdana, 'Noto Sans', sans-serif"
EMPTY = 'No nodes are running in this domain.'


@dataclass(frozen=True)
class Paint:
    fill: str
    edge: str


_PAINTS = {Kind.NODE: Paint('#dbe9fb', '#2563ae'), Kind.TOPIC: Paint('#fdf1d3', '#a87411')}
_FAULTY = Paint('#fde2e0', '#b3261e')


def paint(shape: Shape) -> Paint:
    return _FAULTY if shape.faulty else _PAINTS[shape.kind]
