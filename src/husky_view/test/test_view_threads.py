# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where the thread of the server and the one that draws meet."""

import asyncio
from collections.abc import Iterator
import threading

from husky_view.server import close_server, PageServer
from playpen_testing.page_client import PageClient
import pytest


@pytest.fixture
def server() -> Iterator[PageServer]:
    opened = PageServer('127.0.0.1', 18680, title='threads')
    yield opened
    close_server(opened)


def test_what_is_drawn_wakes_the_tabs_in_the_servers_thread_alone(
    server: PageServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    threads: set[int] = set()
    wake = asyncio.Event.set

    def see_thread(event: asyncio.Event) -> None:
        threads.add(threading.get_ident())
        wake(event)

    monkeypatch.setattr(asyncio.Event, 'set', see_thread)
    with PageClient(server.address) as tab:
        server.gui.add_button('drawn')
        tab.control('drawn')
    assert threads
    assert threading.get_ident() not in threads, 'an event of asyncio is not thread-safe'
