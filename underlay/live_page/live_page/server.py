# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Serve a page on this computer only; it is told of every change (server-sent events).

A browser carries requests of any website to this computer. The page answers under the names of
this computer alone, so that no website can read it under a name of its own (DNS rebinding), and
refuses what comes from another page.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
import json
import os
import subprocess
import sys
from typing import TypeVar
from urllib.parse import parse_qs, SplitResult, urlsplit

HOST = '127.0.0.1'
KEEP_ALIVE_SEC = 5.0
"""How long a page may hear nothing; then `PageHandler.send_sign_of_life` is due."""

Query = dict[str, list[str]]

_NAMES = (HOST, 'localhost')
_LIBRARIES = 'LD_LIBRARY_PATH'
_PORTS_TRIED = 20
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


Page = TypeVar('Page', bound=LivePage)


def serve_somewhere(make: Callable[[int], Page], port: int | None, *, first: int) -> Page:
    """
    Make a page at this port; None: at the first free one from `first` on.

    :raises OSError: the port is taken.
    """
    if port is not None:
        return make(port)
    for candidate in range(first, first + _PORTS_TRIED):
        try:
            return make(candidate)
        except OSError:
            continue
    return make(0)


def read_port(text: str) -> int:
    """
    Read the value of an option `--port`.

    :raises argparse.ArgumentTypeError: if it is no port.
    """
    if not (text.isascii() and text.isdecimal() and 1 <= int(text) <= 65535):
        raise argparse.ArgumentTypeError(f"'{text}' is refused: a port is from 1 to 65535")
    return int(text)


def open_on_a_desktop(address: str) -> None:
    """Open the browser where there is a desktop; returns at once."""
    if not (os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')):
        return
    # A browser must not get the libraries that the wheels of ROS bring.
    paths = os.environ.get(_LIBRARIES, '').split(':')
    others = ':'.join(path for path in paths if not path.startswith(sys.prefix))
    subprocess.Popen(
        [sys.executable, '-m', 'webbrowser', '-t', address],
        cwd='/',  # Python looks first where it starts, where a student may have a shlex.py
        env={**os.environ, _LIBRARIES: others},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,  # browsers say much
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # Ctrl-C ends the program, not the browser
    )


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
