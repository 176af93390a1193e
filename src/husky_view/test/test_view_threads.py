# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where the thread of the server and the one that draws meet."""

import asyncio
from collections.abc import Callable, Iterator
from functools import partial
import threading
import time

from husky_view.picture.camera import add_camera_buttons
from husky_view.picture.page import FOLLOW, TOP
from husky_view.server import ActionQueue, close_server, MOST_ACTIONS, PageServer
from playpen_testing.page_client import PageClient
from playpen_testing.waiting import wait_until
import pytest
import viser


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


def test_a_tab_that_is_closed_while_the_page_is_emptied_is_not_warned_of(
    server: PageServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    with PageClient(server.address):
        wait_until(server.get_clients, timeout_sec=10.0, what='a tab')
        tabs = server.get_clients()
    wait_until(lambda: not server.get_clients(), timeout_sec=10.0, what='its end')
    monkeypatch.setattr(server, 'get_clients', lambda: tabs)
    server.clear()


def test_clicks_that_come_at_once_are_heard_as_they_were_made(server: PageServer) -> None:
    heard: list[str] = []

    def choose(_: viser.ClientHandle, preset: str) -> None:
        heard.append(preset)

    add_camera_buttons(server.gui, lambda action: action(), choose)
    clicked = [TOP, FOLLOW] * 20
    with PageClient(server.address) as tab:
        tab.control('Camera')
        # The server stands still, as on a slow computer: all that is sent comes at once.
        server.gui._event_loop.call_soon_threadsafe(time.sleep, 0.2)
        for preset in clicked:
            tab.set('Camera', preset)
        wait_until(lambda: len(heard) == len(clicked), timeout_sec=10.0, what='every click')
    assert heard == clicked


def test_what_is_urgent_goes_first_and_is_never_left_out() -> None:
    actions, done = ActionQueue(), list[object]()

    def doing(what: object) -> Callable[[], None]:
        return partial(done.append, what)

    for number in range(MOST_ACTIONS + 1):
        actions.put(doing(number))
    actions.put(doing('STOP'), urgent=True)
    actions.run_urgent()
    assert done == ['STOP']
    actions.put(doing('STOP again'), urgent=True)

    def are_all_done() -> bool:
        actions.run()  # as much as fits into a frame
        return len(done) == MOST_ACTIONS + 2

    wait_until(are_all_done, timeout_sec=10.0, what='every action but the last')
    actions.run()
    assert done == ['STOP', 'STOP again', *range(MOST_ACTIONS)]
