# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The web server of the view: its address, its end, and what is clicked on its pages."""

from collections.abc import Callable
from contextlib import redirect_stdout
import errno
import io
from queue import Empty, SimpleQueue
import socket
from threading import Thread

import viser

from husky_view.picture.page import add_page_script

PORTS_TRIED = 100
CLOSE_SEC = 0.5


class AddressError(Exception):
    """The view cannot be served at the address asked for."""


def free_port(host: str, port: int) -> int:
    """
    Return the first free port from `port` on.

    :raises AddressError: if the host is not one of this machine's, or every port is taken.
    """
    try:
        address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except OSError as error:
        raise AddressError(
            f'viewer_host={host!r}: {error.strerror}; 127.0.0.1 is this machine alone, '
            '0.0.0.0 lets others of the network look'
        ) from error
    for candidate in range(port, min(port + PORTS_TRIED, 65536)):
        with socket.socket(address[0], socket.SOCK_STREAM) as trial:
            trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                trial.bind((host, candidate))
            except OSError as error:
                if error.errno in (errno.EADDRINUSE, errno.EACCES, errno.EPERM):
                    continue
                raise AddressError(f'viewer_host={host!r}: {error.strerror}') from error
            return candidate
    raise AddressError(
        f'viewer_port={port}: no free port from {port} to {port + PORTS_TRIED - 1}; give another'
    )


def open_server(host: str, port: int, *, title: str) -> viser.ViserServer:
    """
    Serve an empty page.

    :raises AddressError: if the address cannot be had.
    """
    port = free_port(host, port)
    with redirect_stdout(io.StringIO()):  # viser prints a banner
        server = viser.ViserServer(host=host, port=port, label=title, verbose=False)
    server.gui.configure_theme(control_width='medium', show_logo=False, show_share_button=False)
    server.gui.set_panel_label(title)
    server.scene.set_up_direction('+z')
    add_page_script(server)
    return server


def close_server(server: viser.ViserServer) -> None:
    """Close every page; may be called twice."""
    # viser waits up to 6 s for every page to close its connection, also for one that hangs.
    closing = Thread(target=server.stop, daemon=True)
    with redirect_stdout(io.StringIO()):
        closing.start()
        closing.join(CLOSE_SEC)


def address_of(server: viser.ViserServer) -> str:
    """Return the URL of the page."""
    host = server.get_host()
    local = host in ('127.0.0.1', '0.0.0.0', '::', '::1', 'localhost')  # noqa: S104
    return f'http://{"localhost" if local else host}:{server.get_port()}'


class ActionQueue:
    """
    Actions from the server's threads, run by the thread that owns everything else.

    viser calls the callbacks of clicks on threads of its own.
    """

    def __init__(self) -> None:
        self._queue: SimpleQueue[Callable[[], object]] = SimpleQueue()

    def put(self, action: Callable[[], object]) -> None:
        """Add an action; from any thread."""
        self._queue.put(action)

    def run(self) -> None:
        """Run what was added since the last call."""
        while True:
            try:
                action = self._queue.get_nowait()
            except Empty:
                return
            action()
