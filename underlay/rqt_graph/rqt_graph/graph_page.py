# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The page of the graph: which topics it shows, and what it tells of each change."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from live_page.server import KEEP_ALIVE_SEC, Query
from ros2cli.discovery import read_graph, settings_from_environment
from ros2cli.errors import CommandError
from rtps_graph.graph import Graph

from rqt_graph.document import fill
from rqt_graph.feed import Feed
from rqt_graph.picture import draw_png, draw_svg
from rqt_graph.selection import Drawing, Kind, select, View

_FIRST_GRAPH_SEC = 10.0
_CONTROLS = """\
  <select id="view" aria-label="what is shown">
    <option value="active">Nodes/Topics (active)</option>
    <option value="all">Nodes/Topics (all)</option>
  </select>
  <label><input id="debug" type="checkbox" checked> Hide debug</label>
"""
_LEGEND = """\
<span class="key" style="margin-left:0"></span>node
  <span class="key topic"></span>topic
  <span class="key fault"></span>nothing arrives: types or QoS differ (point at it)"""
_FUNCTIONS = """\
const view = () => byId('view'), debug = () => byId('debug');
const query = () => `?view=${view().value}&debug=${debug().checked ? 'hidden' : 'shown'}`;
const describe = (news) => `${count(news.nodes, 'node')}, ${count(news.topics, 'topic')}`;
function begin() {
  for (const control of [view(), debug()]) control.addEventListener('change', listen);
  const asked = new URLSearchParams(location.search);
  if (asked.get('view') === 'all') view().value = 'all';
  if (asked.get('debug') === 'shown') debug().checked = false;
}
"""


class GraphPage:
    """Nodes and topics of the domain, read again while somebody looks."""

    def __init__(self) -> None:
        self._feed: Feed[Graph] = Feed(_read)

    def html(self) -> bytes:
        return fill(
            title='rqt_graph',
            file='rosgraph',
            controls=_CONTROLS,
            legend=_LEGEND,
            functions=_FUNCTIONS,
        )

    def picture(self, query: Query, picture_format: str) -> bytes:
        with self._feed.watching():
            _, graph = self._feed.wait(0, _FIRST_GRAPH_SEC)
        drawing = _select(graph, query) if graph else Drawing((), ())
        return draw_png(drawing) if picture_format == 'png' else draw_svg(drawing)

    def events(self, query: Query) -> Iterator[dict[str, Any] | None]:
        version, shown = 0, None
        domain_id = settings_from_environment().domain_id
        with self._feed.watching():
            while True:
                version, graph = self._feed.wait(version, KEEP_ALIVE_SEC)
                drawing = _select(graph, query) if graph else None
                if drawing is None or drawing == shown:
                    yield None
                    continue
                shown = drawing
                yield {
                    'svg': draw_svg(drawing).decode(),
                    'nodes': drawing.count(Kind.NODE),
                    'topics': drawing.count(Kind.TOPIC),
                    'domain': domain_id,
                }


def _read() -> Graph | None:
    try:
        return read_graph(quiet=True)
    except CommandError:
        return None  # what is wrong with the environment was said at the start


def _select(graph: Graph, query: Query) -> Drawing:
    view = View.ALL if query.get('view') == [View.ALL.value] else View.ACTIVE
    return select(graph, view, debug=query.get('debug') == ['shown'])
