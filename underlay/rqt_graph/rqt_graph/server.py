# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Serve the page on this computer only; it is told of every change (server-sent events)."""

from __future__ import annotations

from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
import json
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

from ros2cli.discovery import settings_from_environment

from rqt_graph.feed import GraphFeed
from rqt_graph.picture import draw_png, draw_svg
from rqt_graph.selection import Drawing, Kind, select, View

HOST = '127.0.0.1'
FIRST_PORT = 8090
_PORTS_TRIED = 20
_KEEP_ALIVE_SEC = 5.0
_FIRST_GRAPH_SEC = 10.0
_PAGE = Path(__file__).with_name('page.html')


class GraphServer(ThreadingHTTPServer):
    """The page and the pictures; requests are served in threads that end with the process."""

    daemon_threads = True
    block_on_close = False

    def __init__(self, port: int) -> None:
        self.feed = GraphFeed()
        super().__init__((HOST, port), _Handler)

    @property
    def address(self) -> str:
        return f'http://{HOST}:{self.server_port}/'


def serve_somewhere(port: int | None) -> GraphServer:
    """Serve at this port; None: at the first free one.

    :raises OSError: the port is taken.
    """
    if port is not None:
        return GraphServer(port)
    for candidate in range(FIRST_PORT, FIRST_PORT + _PORTS_TRIED):
        try:
            return GraphServer(candidate)
        except OSError:
            continue
    return GraphServer(0)


class _Handler(BaseHTTPRequestHandler):
    server: GraphServer
    protocol_version = 'HTTP/1.1'

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002
        """Keep the terminal quiet."""

    def do_GET(self) -> None:
        target = urlsplit(self.path)
        asked = parse_qs(target.query)
        view = View.ALL if asked.get('view') == [View.ALL.value] else View.ACTIVE
        debug = asked.get('debug') == ['shown']
        try:
            if target.path == '/':
                self._answer('text/html; charset=utf-8', _PAGE.read_bytes())
            elif target.path == '/events':
                self._send_changes(view, debug=debug)
            elif target.path == '/graph.svg':
                self._answer('image/svg+xml', draw_svg(self._drawing(view, debug=debug)))
            elif target.path == '/graph.png':
                self._answer('image/png', draw_png(self._drawing(view, debug=debug)))
            else:
                self.send_error(404)
        except ConnectionError:
            self.close_connection = True  # The page was closed.

    def _drawing(self, view: View, *, debug: bool) -> Drawing:
        with self.server.feed.watching():
            _, graph = self.server.feed.wait(0, _FIRST_GRAPH_SEC)
        return select(graph, view, debug=debug) if graph else Drawing((), ())

    def _send_changes(self, view: View, *, debug: bool) -> None:
        self._begin('text/event-stream', None)
        version, shown = 0, None
        domain_id = settings_from_environment().domain_id
        with self.server.feed.watching():
            while True:
                version, graph = self.server.feed.wait(version, _KEEP_ALIVE_SEC)
                drawing = select(graph, view, debug=debug) if graph else None
                if drawing is None or drawing == shown:
                    self.wfile.write(b': still here\n\n')
                    continue
                shown = drawing
                event = {
                    'svg': draw_svg(drawing).decode(),
                    'nodes': drawing.count(Kind.NODE),
                    'topics': drawing.count(Kind.TOPIC),
                    'domain': domain_id,
                }
                self.wfile.write(f'data: {json.dumps(event)}\n\n'.encode())

    def _answer(self, content_type: str, body: bytes) -> None:
        self._begin(content_type, len(body))
        self.wfile.write(body)

    def _begin(self, content_type: str, length: int | None) -> None:
        self.send_response(200)
        self.send_header('Content-Type', content_type)
        self.send_header('Cache-Control', 'no-store')
        if length is None:
            self.send_header('Connection', 'close')
        else:
            self.send_header('Content-Length', str(length))
        self.end_headers()
