# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The page of the frames: a tree that follows what is sent."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
import time
from typing import Any

from live_page.server import KEEP_ALIVE_SEC, Query
from rqt_graph.document import fill
from rqt_graph.feed import Feed
from rqt_graph.picture import as_text, draw, empty_graph, FAULTY, NODE_LOOK

from tf2_tools.frames import Frame, read_frames

_SILENT_SEC = 5.0  # a frame that moves and has no newer transform for so long is not sent any more
_LEGEND = """\
<span class="key" style="margin-left:0"></span>frame, below its parent: times a second, or static
  <span class="key fault"></span>no newer transform for 5 s (point at it)"""
_FUNCTIONS = """\
const query = () => '';
const describe = (news) => count(news.frames, 'frame');
const begin = () => {};"""


@dataclass(frozen=True)
class Edge:
    """An arrow from a frame's parent to it."""

    parent: str
    child: str
    label: str
    note: str
    silent: bool


class FramesPage:
    """The frames of a buffer, read again while somebody looks."""

    def __init__(self, frame_yaml: Callable[[], str], domain_id: int) -> None:
        self._frame_yaml = frame_yaml
        self._domain_id = domain_id
        self._news: dict[str, tuple[float, float]] = {}
        self._feed: Feed[tuple[Edge, ...]] = Feed(self._read)

    def html(self) -> bytes:
        return fill(
            title='view_frames', file='frames', controls='', legend=_LEGEND, functions=_FUNCTIONS
        )

    def picture(self, query: Query, picture_format: str) -> bytes:
        with self._feed.watching():
            _, edges = self._feed.wait(0, KEEP_ALIVE_SEC)
        return draw(_graph(edges or ()), picture_format)

    def events(self, query: Query) -> Iterator[dict[str, Any] | None]:
        version, shown = 0, None
        with self._feed.watching():
            while True:
                version, edges = self._feed.wait(version, KEEP_ALIVE_SEC)
                if edges is None or edges == shown:
                    yield None
                    continue
                shown = edges
                yield {
                    'svg': draw(_graph(edges), 'svg').decode(),
                    'frames': len(_names(edges)),
                    'domain': self._domain_id,
                }

    def _read(self) -> tuple[Edge, ...]:
        frames = read_frames(self._frame_yaml())
        return tuple(self._edge(frame) for frame in sorted(frames, key=lambda each: each.name))

    def _edge(self, frame: Frame) -> Edge:
        label = 'static' if frame.is_static else f'{frame.rate_hz:.2g} Hz'
        known, since = self._news.get(frame.name, (None, 0.0))
        if known != frame.most_recent_sec:
            since = time.monotonic()
            self._news[frame.name] = (frame.most_recent_sec, since)
        silent = not frame.is_static and time.monotonic() - since > _SILENT_SEC
        note = f'{frame.parent} to {frame.name}\nbroadcaster: {frame.broadcaster}\n{label}'
        if silent:
            note += f'\nno newer transform than that of {frame.most_recent_sec:.3f}'
        return Edge(frame.parent, frame.name, label, note, silent)


def _names(edges: tuple[Edge, ...]) -> list[str]:
    return sorted({name for edge in edges for name in (edge.parent, edge.child)})


def _graph(edges: tuple[Edge, ...]) -> Any:
    empty = '' if edges else 'No transforms arrive in this domain.'
    graph = empty_graph(empty, direction='TB')
    notes = {edge.child: edge for edge in edges}
    for name in _names(edges):
        edge = notes.get(name)
        look = NODE_LOOK | (FAULTY if edge and edge.silent else {})
        note = edge.note if edge else name
        graph.add_node(
            _key(name), **look, label=as_text(name), id=as_text(name), tooltip=as_text(note)
        )
    for edge in edges:
        graph.add_edge(
            _key(edge.parent),
            _key(edge.child),
            id=as_text(f'{edge.parent}>{edge.child}'),
            label=f' {edge.label}',
            tooltip=as_text(edge.note),
        )
    return graph


def _key(name: str) -> str:
    return f'frame {name}'  # a name that begins with % is none to Graphviz
