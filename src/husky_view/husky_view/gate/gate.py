# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The gate in front of viser's server.

Nobody gets past who is not admitted, nor any message that a page of ours does not send.
viser 1.1 takes every request and every message, and has no hook for either. It serves by
`websockets`, which has one for both; so the gate is put in where viser starts to serve.
"""

import asyncio
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from http import HTTPStatus
import logging
from typing import Any

import viser
from websockets.asyncio import server as websockets_server
from websockets.asyncio.server import serve, Server, ServerConnection
from websockets.datastructures import Headers
from websockets.frames import DATA_OPCODES, Frame, Opcode
from websockets.http11 import Request, Response
from websockets.protocol import Event

from husky_view.gate.admission import Admission
from husky_view.gate.controls import accepts
from husky_view.gate.front_page import ALIVE, front_page
from husky_view.gate.incoming import (
    FIRST_CAMERA,
    GuiUpdateMessage,
    Incoming,
    read_message,
    Refused,
    ViewerCameraMessage,
)

MOST_BYTES = 4096
"""Of a message; a page sends half a kilobyte at most."""

MOST_FRAMES = 16
"""Of a message: a browser cuts one in two where a buffer of its own ends."""

MOST_PINGS = 1000
"""
Whose answers wait to be read; a browser sends none.

Since Python 3.12 asyncio adds up what waits whenever something is written, so that the time for
the answers grows with their square.
"""

MOST_UNREAD_BYTES = 8_000_000
"""Kept for a tab that sends and does not read; twice the whole scene."""

MOST_TABS, MOST_CONNECTIONS = 32, 256
HANDSHAKE_SEC = 5.0

RATE_HZ, BURST = 200.0, 400
"""How many messages of a tab are read: a page sends 50 a second and some. More have to wait."""

_HEADERS = {
    'Cache-Control': 'no-store',
    'Cross-Origin-Resource-Policy': 'same-origin',
    'Referrer-Policy': 'no-referrer',
    'X-Content-Type-Options': 'nosniff',
}
_PROTOCOL = f'viser-v{viser.__version__}'
_log = logging.getLogger(__name__)


class Gate:
    """
    Decides who is admitted and which messages pass. It belongs to the server's thread.

    :param title: of the page.
    """

    def __init__(self, admission: Admission, *, title: str) -> None:
        self.control_of: Callable[[str], Any] = lambda _: None  # by its uuid
        self.is_open = False
        self._admission = admission
        self._page = front_page(title)

    @contextmanager
    def in_front(self) -> Iterator[None]:
        """
        Stand in front of the server that viser starts meanwhile.

        :raises RuntimeError: at the end, if viser has not come by here.
        """
        before = websockets_server.serve
        websockets_server.serve = self._serve  # type: ignore[assignment, misc]
        try:
            yield
        finally:
            websockets_server.serve = before  # type: ignore[misc]
        if not self.is_open:
            raise RuntimeError('viser serves in another way than 1.1: nothing would be checked')

    def _serve(
        self, handler: Callable[[ServerConnection], Awaitable[None]], *place: Any, **options: Any
    ) -> serve:
        self.is_open = True
        mine = {
            'process_request': self._process_request,
            'create_connection': self._connection,
            'max_size': MOST_BYTES,
            'open_timeout': HANDSHAKE_SEC,
            'logger': _quiet_logger(),
        }
        return serve(handler, *place, **{**options, **mine})

    def _connection(self, *args: Any, **options: Any) -> ServerConnection:
        return CheckedConnection(self.admitted, *args, **options)

    def _process_request(self, connection: ServerConnection, request: Request) -> Response | None:
        headers = request.headers
        refusal = self._admission.refusal(
            request.path, headers.get_all('Host'), headers.get_all('Origin')
        )
        if refusal is not None:
            return connection.respond(refusal.status, f'{refusal.reason}\n')
        if 'Upgrade' in headers:
            if headers.get_all('Sec-WebSocket-Protocol') != [_PROTOCOL]:
                return connection.respond(HTTPStatus.BAD_REQUEST, f'Spoken here: {_PROTOCOL}.\n')
            if len(connection.server.connections) < MOST_TABS:
                return None
            full = f'{MOST_TABS} tabs look at this page already: close one.\n'
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, full)
        path = request.path.partition('?')[0].rstrip('/')
        if path == f'/{self._admission.token}/{ALIVE}':
            return Response(204, 'No Content', Headers({'Connection': 'close', **_HEADERS}))
        if path.count('/') > 1:
            return connection.respond(HTTPStatus.NOT_FOUND, 'There is one page here.\n')
        described = {'Content-Type': 'text/html; charset=utf-8', 'Connection': 'close'}
        length = {'Content-Length': str(len(self._page))}
        return Response(200, 'OK', Headers({**described, **length, **_HEADERS}), self._page)

    def admitted(self, raw: str | bytes) -> Incoming | None:
        """Return a message that the page may send now, None for any other."""
        try:
            message = read_message(raw)
        except Refused as error:
            _log.debug('refused: %s', error)
            return None
        if isinstance(message, GuiUpdateMessage) and not accepts(
            self.control_of(message.uuid), message.updates.value
        ):
            return None
        return message


class CheckedConnection(ServerConnection):
    """
    The connection of a tab, which hands on what is admitted and drops the rest.

    viser hears nobody who has not told of a camera yet: it keeps the value of a control, and
    calls nothing. A page on a slow computer tells of its camera long after it shows STOP: what is
    clicked before has a camera go ahead of it.

    :param admitted: returns a message that is admitted, None for any other.
    """

    def __init__(
        self,
        admitted: Callable[[str | bytes], Incoming | None],
        protocol: Any,
        server: Server,
        **options: Any,
    ) -> None:
        super().__init__(protocol, server, **options)
        self._admitted = admitted
        self._is_heard = False
        self._held: str | bytes | None = None  # until its camera has gone ahead
        self._frames = 0  # of a message that is not whole yet
        self._pings = 0  # since nothing waited to be read
        self._free_sec = 0.0  # when all that was read would have been due

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Take a connection, if there are not too many."""
        super().connection_made(transport)
        if len(self.server.handlers) > MOST_CONNECTIONS:
            self.transport.abort()

    def process_event(self, event: Event) -> None:
        """Take a request or a frame; end a connection that would have ever more kept of it."""
        super().process_event(event)
        if isinstance(event, Frame) and event.opcode in DATA_OPCODES:
            self._frames = 0 if event.fin else self._frames + 1
        unread = self.transport.get_write_buffer_size()
        is_ping = isinstance(event, Frame) and event.opcode is Opcode.PING
        self._pings = self._pings + is_ping if unread else 0
        if self._frames > MOST_FRAMES or self._pings > MOST_PINGS or unread > MOST_UNREAD_BYTES:
            self.transport.abort()

    async def recv(self, decode: bool | None = None) -> str | bytes:  # type: ignore[override]
        """Wait for the next message that is admitted."""
        if self._held is not None:
            raw, self._held = self._held, None
            return raw
        while True:
            raw = await super().recv(decode)
            await self._keep_to_the_rate()
            message = self._admitted(raw)
            if message is not None:
                break
        if not self._is_heard and not isinstance(message, ViewerCameraMessage):
            self._held, raw = raw, FIRST_CAMERA
        self._is_heard = True
        return raw

    async def _keep_to_the_rate(self) -> None:
        now = self.loop.time()
        self._free_sec = max(self._free_sec, now - BURST / RATE_HZ) + 1.0 / RATE_HZ
        if self._free_sec > now:
            await asyncio.sleep(self._free_sec - now)


def _quiet_logger() -> logging.Logger:
    """Return a logger that leaves out what anybody can cause."""
    logger = logging.getLogger(f'{__name__}.server')
    logger.addFilter(lambda record: not _is_of_a_stranger(record))
    return logger


def _is_of_a_stranger(record: logging.LogRecord) -> bool:
    """Tell whether a record is of garbage instead of a request, or behind one."""
    if record.getMessage() == 'opening handshake failed':
        return True
    # To what comes behind a request before its answer, websockets ends the connection, and then
    # wants to end it with the answer, too.
    error = record.exc_info and record.exc_info[1]
    return record.getMessage() == 'unexpected internal error' and isinstance(error, AssertionError)
