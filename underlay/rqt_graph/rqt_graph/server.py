# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Serve the page on this computer only; it is told of every change."""

from __future__ import annotations

from pathlib import Path

from live_page import KEEP_ALIVE_SEC, LivePage, PageHandler, Query
from ros2cli.discovery import settings_from_environment

from rqt_graph.feed import GraphFeed
from rqt_graph.picture import draw_png, draw_svg
from rqt_graph.selection import Drawing, Kind, select, View

FIRST_PORT = 8090
_FIRST_GRAPH_SEC = 10.0
_PAGE = Path(__file__).with_name('page.html')


class GraphServer(LivePage):
    """The page and the pictures."""

    def __init__(self, port: int) -> None:
        self.feed = GraphFeed()
        super().__init__(port, _Handler)


class _Handler(PageHandler):
    server: GraphServer

    def answer(self, path: str, query: Query) -> None:
        match path:
            case '/':
                self.send('text/html; charset=utf-8', _PAGE.read_bytes())
            case '/events':
                self._send_changes(query)
            case '/graph.svg':
                self.send('image/svg+xml', draw_svg(self._drawing(query)))
            case '/graph.png':
                self.send('image/png', draw_png(self._drawing(query)))
            case _:
                super().answer(path, query)

    def _drawing(self, query: Query) -> Drawing:
        view, debug = _asked(query)
        with self.server.feed.watching():
            _, graph = self.server.feed.wait(0, _FIRST_GRAPH_SEC)
        return select(graph, view, debug=debug) if graph else Drawing((), ())

    def _send_changes(self, query: Query) -> None:
        self.begin_events()
        view, debug = _asked(query)
        version, shown = 0, None
        domain_id = settings_from_environment().domain_id
        with self.server.feed.watching():
            while True:
                version, graph = self.server.feed.wait(version, KEEP_ALIVE_SEC)
                drawing = select(graph, view, debug=debug) if graph else None
                if drawing is None or drawing == shown:
                    self.send_sign_of_life()
                    continue
                shown = drawing
                self.send_event(
                    {
                        'svg': draw_svg(drawing).decode(),
                        'nodes': drawing.count(Kind.NODE),
                        'topics': drawing.count(Kind.TOPIC),
                        'domain': domain_id,
                    }
                )


def _asked(query: Query) -> tuple[View, bool]:
    """Return what is to be shown, and whether with the names that every graph has."""
    view = View.ALL if query.get('view') == [View.ALL.value] else View.ACTIVE
    return view, query.get('debug') == ['shown']
