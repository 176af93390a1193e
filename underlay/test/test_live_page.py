# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The server of pages: what any program on this computer may send to it."""

from __future__ import annotations

from collections.abc import Iterator
import socket
import struct
import threading

from live_page.server import LivePage, PageHandler, Query
import pytest


class _Handler(PageHandler):
    def answer(self, path: str, query: Query) -> None:
        if path == '/':
            self.send('text/plain', b'here')
        else:
            super().answer(path, query)


@pytest.fixture
def page() -> Iterator[LivePage]:
    with LivePage(0, _Handler) as server:
        serving = threading.Thread(target=server.serve_forever, args=(0.05,))
        serving.start()
        yield server
        server.shutdown()
        serving.join()


def _ask(page: LivePage, target: str) -> bytes:
    with socket.create_connection(('127.0.0.1', page.server_port), timeout=5.0) as asking:
        host = f'127.0.0.1:{page.server_port}'
        asking.sendall(f'GET {target} HTTP/1.1\r\nHost: {host}\r\n\r\n'.encode())
        return asking.recv(1000)


@pytest.mark.parametrize(
    'target', ['//[', 'http://[::1', '/../../etc/passwd', '/%2e%2e/', '/\xff', '/?%ff=\x01']
)
def test_any_address_is_answered_without_a_word(
    page: LivePage, target: str, capfd: pytest.CaptureFixture[str]
) -> None:
    status = 200 if target.startswith('/?') else 404
    assert _ask(page, target).startswith(f'HTTP/1.1 {status} '.encode())
    assert capfd.readouterr().err == ''


def test_a_browser_that_goes_at_once_is_not_told_of(
    page: LivePage, capfd: pytest.CaptureFixture[str]
) -> None:
    before = threading.active_count()
    for begun in (b'', b'GET / HT', b'GET / HTTP/1.1\r\n'):
        going = socket.create_connection(('127.0.0.1', page.server_port), timeout=5.0)
        going.sendall(begun)
        # Closed by a reset, which the server's next read raises.
        going.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        going.close()
    assert _ask(page, '/').startswith(b'HTTP/1.1 200 ')
    for thread in threading.enumerate()[before:]:
        thread.join(5.0)
    assert capfd.readouterr().err == ''
