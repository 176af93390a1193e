# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Serve a page on this computer only; it is told of every change (server-sent events).

A browser carries requests of any website to this computer. The page answers under the names of
this computer alone, so that no website can read it under a name of its own (DNS rebinding), and
refuses what comes from another page.
"""

from __future__ import annotations

from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
import json
import sys
from urllib.parse import parse_qs, SplitResult, urlsplit

HOST = '127.0.0.1'
KEEP_ALIVE_SEC = 5.0
"""How long a page may hear nothing; then `PageHandler.send_sign_of_life` is due."""

Query = dict[str, list[str]]

_NAMES = (HOST, 'localhost')
_STALLED_SEC = 20.0


class LivePage(ThreadingHTTPServer):
    """A page; its requests are served in threads that end with the process."""

    daemon_threads = True
    block_on_close = False

    def __init__(self, port: int, handler: type[PageHandler]) -> None:
        super().__init__((HOST, port), handler)

    def handle_error(self, request: object, client_address: object) -> None:
        """Say nothing of a browser that has gone in the middle of a request."""
        if not isinstance(sys.exc_info()[1], OSError):
            super().handle_error(request, client_address)  # type: ignore[arg-type]

    @property
    def address(self) -> str:
        return f'http://{HOST}:{self.server_port}/'


class PageHandler(BaseHTTPRequestHandler):
    """Answers requests that come from this computer and its own page."""

    protocol_version = 'HTTP/1.1'
    timeout = _STALLED_SEC  # a page that neither reads nor asks is left
    server: LivePage

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002
        """Keep the terminal quiet."""

    def do_GET(self) -> None:
        target = _split(self.path)
        try:
            if refusal := self._refusal():
                self.send_error(refusal)
            else:
                self.answer(target.path, parse_qs(target.query))
        except OSError:
            self.close_connection = True  # the page was closed, or stands still

    def answer(self, path: str, query: Query) -> None:
        """Answer a request that is not refused; a page says here what it has."""
        self.send_error(HTTPStatus.NOT_FOUND)

    def _refusal(self) -> HTTPStatus | None:
        hosts, origins = (self.headers.get_all(name, []) for name in ('Host', 'Origin'))
        if len(hosts) != 1 or _split(f'//{hosts[0]}').hostname not in _NAMES:
            return HTTPStatus.MISDIRECTED_REQUEST
        if any(_split(origin).netloc != hosts[0] for origin in origins):
            return HTTPStatus.FORBIDDEN
        return None

    def send(self, content_type: str, body: bytes) -> None:
        """Send all of an answer."""
        self._begin(content_type, ('Content-Length', str(len(body))))
        self.wfile.write(body)

    def begin_events(self) -> None:
        """Begin an answer of events, which ends with the connection."""
        self._begin('text/event-stream', ('Connection', 'close'))

    def send_event(self, event: object) -> None:
        self.wfile.write(f'data: {json.dumps(event)}\n\n'.encode())

    def send_sign_of_life(self) -> None:
        """Notice a page that was closed, though there is nothing new."""
        self.wfile.write(b': still here\n\n')

    def _begin(self, content_type: str, how_long: tuple[str, str]) -> None:
        self.send_response(HTTPStatus.OK)
        self.send_header('Content-Type', content_type)
        self.send_header('Cache-Control', 'no-store')
        self.send_header('X-Content-Type-Options', 'nosniff')
        self.send_header(*how_long)
        self.end_headers()


def _split(address: str) -> SplitResult:
    try:
        return urlsplit(address)
    except ValueError:
        return SplitResult('', '', '', '', '')
