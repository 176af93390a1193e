# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Serve a picture that changes, on a page and in files; on this computer only."""

from __future__ import annotations

from collections.abc import Iterator
import signal
from typing import Any, Protocol

from live_page import open_on_a_desktop, serve_somewhere
from live_page.server import LivePage, PageHandler, Query
from ros2cli import interrupts
from ros2cli.errors import CommandError

FIRST_PORT = 8090


class Page(Protocol):
    """What is shown: a document that asks for events, and the picture in files."""

    def html(self) -> bytes: ...

    def picture(self, query: Query, picture_format: str) -> bytes: ...

    def events(self, query: Query) -> Iterator[dict[str, Any] | None]:
        """Tell each change, at least every few seconds; None where there was none."""
        ...


class PictureServer(LivePage):
    """The page and the pictures."""

    def __init__(self, port: int, page: Page) -> None:
        self.page = page
        super().__init__(port, _Handler)


def show(page: Page, port: int | None, said: str, query: str = '') -> None:
    """
    Serve a page until Ctrl-C, and open it where there is a display.

    :param port: None: the first free one.
    :param said: what the terminal says, with {} for the address.
    :raises CommandError: the port is taken.
    """
    try:
        server = serve_somewhere(
            lambda number: PictureServer(number, page), port, first=FIRST_PORT
        )
    except OSError:
        raise CommandError(f'--port {port} is taken: leave it out to get a free one') from None
    # Whatever ends it ends it as Ctrl-C does.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    interrupts.heed_in_background()
    address = server.address + query
    print(said.format(address), flush=True)
    open_on_a_desktop(address)
    with server:
        server.serve_forever(poll_interval=0.2)


class _Handler(PageHandler):
    server: PictureServer

    def answer(self, path: str, query: Query) -> None:
        page = self.server.page
        match path:
            case '/':
                self.send('text/html; charset=utf-8', page.html())
            case '/events':
                self._send_changes(query)
            case '/graph.svg':
                self.send('image/svg+xml', page.picture(query, 'svg'))
            case '/graph.png':
                self.send('image/png', page.picture(query, 'png'))
            case _:
                super().answer(path, query)

    def _send_changes(self, query: Query) -> None:
        self.begin_events()
        for event in self.server.page.events(query):
            if event is None:
                self.send_sign_of_life()
            else:
                self.send_event(event)
