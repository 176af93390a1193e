# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The web server of the view: which address it gets, and how its page looks."""

from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
import io
import socket
from threading import Thread

import viser

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
            except PermissionError:
                continue
            except OSError as error:
                if error.errno in (98, 48):  # EADDRINUSE of Linux, of BSD
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
    with _silence():
        server = viser.ViserServer(host=host, port=port, label=title, verbose=False)
    server.gui.configure_theme(control_width='medium', show_logo=False, show_share_button=False)
    server.gui.set_panel_label(title)
    server.scene.set_up_direction('+z')
    return server


def close_server(server: viser.ViserServer) -> None:
    """Close every page; may be called twice."""
    # viser waits for every page to say goodbye, up to 6 s; one that hangs must not delay us.
    closing = Thread(target=server.stop, daemon=True)
    with _silence():
        closing.start()
        closing.join(CLOSE_SEC)


@contextmanager
def _silence() -> Iterator[None]:
    """Keep viser's own banner out of the terminal: one line of ours tells the address."""
    with redirect_stdout(io.StringIO()):
        yield


def address_of(server: viser.ViserServer) -> str:
    """Return what a person types into the browser."""
    host = server.get_host()
    local = host in ('127.0.0.1', '0.0.0.0', '::', '::1', 'localhost')  # noqa: S104
    return f'http://{"localhost" if local else host}:{server.get_port()}'
