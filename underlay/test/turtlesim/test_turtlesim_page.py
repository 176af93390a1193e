# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of the turtles: what a page is told, and what a browser shows of it."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from contextlib import contextmanager
import http.client
import json
from pathlib import Path
import re
import socket
import sys
import time
from typing import Any
from urllib.parse import urlsplit

import numpy as np
from numpy.typing import NDArray
from playpen_testing import chromium
from playpen_testing.browser import (
    errors,
    hide,
    keep_still,
    KEPT,
    pixels_of,
    start_browser,
    wait_for,
)
from playpen_testing.processes import Process, Processes
from playpen_testing.turtles import TurtleClient
from playpen_testing.waiting import wait_until
from playwright.sync_api import Browser, Page
import psutil
import pytest
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from std_srvs.srv import Empty
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute

BLUE, PEN = (69, 86, 255), (0xB3, 0xB8, 0xFF)
NODE = (str(Path(sys.prefix) / 'lib' / 'turtlesim' / 'turtlesim_node'),)
ADDRESS = re.compile(r'http://127\.0\.0\.1:\d+/')


@pytest.fixture(scope='module')
def shared_browser() -> Iterator[Browser]:
    with start_browser(chromium.find_or_install()) as started:
        yield started


@pytest.fixture
def browser(shared_browser: Browser) -> Iterator[Browser]:
    """Close the pages of each test."""
    yield shared_browser
    for context in shared_browser.contexts:
        context.close()


@pytest.fixture(scope='module')
def shared_turtlesim(shared_processes: Processes) -> Process:
    """Start a turtlesim with its page."""
    return start(shared_processes)


@pytest.fixture(scope='module')
def shared_address(shared_turtlesim: Process) -> str:
    return address_of(shared_turtlesim)


@pytest.fixture
def address(shared_address: str, turtlesim: Process) -> str:
    """Return the address of the shared turtlesim, where it is told that it was reset."""
    del turtlesim
    with events_of(shared_address) as events:
        while not is_as_at_first(events.next(), events.pixels):
            pass
    return shared_address


def is_as_at_first(told: dict[str, Any], pixels: NDArray[np.uint32]) -> bool:
    turtles = told['turtles']
    return bool(
        [name for name, *_ in turtles] == ['turtle1']
        and turtles[0][1:4] == pytest.approx([249.5, 249.5, 0.0], abs=0.01)
        and told['background'] == list(BLUE)
        and not (pixels >> 24).any()
    )


def start(processes: Processes, *words: str) -> Process:
    started = processes.start(*NODE, *words)
    started.wait_for_text('The turtles are at http://')
    return started


def address_of(turtlesim: Process) -> str:
    return ADDRESS.findall(turtlesim.output)[0]


class Events:
    """What a page is told, put together as the page does."""

    def __init__(self, address: str) -> None:
        self._connection = http.client.HTTPConnection(urlsplit(address).netloc, timeout=20.0)
        self._connection.request('GET', '/events')
        self._answer = self._connection.getresponse()
        self.pixels = np.full(500 * 500, 0x00FFFFFF, np.uint32)
        self.count = 0
        self.newest: dict[str, Any] = {}

    def line(self) -> bytes:
        return self._answer.readline()

    def next(self) -> dict[str, Any]:
        while not (line := self.line()).startswith(b'data: '):
            assert line, 'the stream has ended'
        self.newest = json.loads(line.removeprefix(b'data: '))
        words = np.frombuffer(base64.b64decode(self.newest['pixels']), '<u4')
        places, values = np.split(words, 2)
        self.pixels[places] = values
        self.count += 1
        return self.newest

    def close(self) -> None:
        self._answer.close()
        self._connection.close()


@contextmanager
def events_of(address: str) -> Iterator[Events]:
    events = Events(address)
    try:
        yield events
    finally:
        events.close()


def test_a_page_is_told_what_moves_thirty_times_a_second(
    address: str, student: TurtleClient
) -> None:
    with events_of(address) as events:
        first = events.next()
        assert first['background'] == list(BLUE)
        assert [turtle[0] for turtle in first['turtles']] == ['turtle1']
        assert first['turtles'][0][1:4] == pytest.approx([249.5, 249.5, 0.0], abs=0.01)
        student.command('turtle1', x=1.0)
        while not (events.pixels >> 24).any():
            events.next()
        assert set(np.unique(events.pixels)) == {0x00FFFFFF, 0xFFB3B8FF}
        # A moment without a processor costs events, or brings them at once: then once more.
        deadline, rates, theta = time.monotonic() + 60.0, [0.0], 0.0
        while not 15.0 < rates[-1] < 62.0:
            assert time.monotonic() < deadline, f'events a second: {rates[1:]}'
            theta = 1.0 - theta
            student.rotate(theta)  # to there, however many frames are lost
            events.next()
            began, count = time.monotonic(), events.count
            while abs(events.newest['turtles'][0][3] - theta) > 0.2:
                events.next()
            rates.append((events.count - count) / (time.monotonic() - began))


def test_a_later_page_has_the_same_picture(address: str, student: TurtleClient) -> None:
    with events_of(address) as early:
        early.next()
        student.call(SetPen, 'turtle1/set_pen', r=200, g=10, b=10, width=7)
        student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=1.0, y=2.0)
        student.call(Spawn, 'spawn', x=9.0, y=9.0, name='late')
        while early.newest['turtles'][0][0] != 'late' or not (early.pixels >> 24).any():
            early.next()
        with events_of(address) as late:
            late.next()
            assert (late.pixels == early.pixels).all()
            assert late.newest['turtles'] == early.newest['turtles']
            student.call(Empty, 'clear')
            for page in (early, late):
                page.next()
                assert not (page.pixels >> 24).any()


@pytest.mark.usefixtures('own_domain')
def test_nothing_is_sent_while_nothing_moves(processes: Processes) -> None:
    with events_of(address_of(start(processes))) as events:
        events.next()
        assert [events.line() for _ in range(3)] == [b'\n', b': still here\n', b'\n']


def open_page(browser: Browser, address: str, width: int = 700, height: int = 640) -> Page:
    page = browser.new_page(viewport={'width': width, 'height': height})
    page.goto(address)
    wait_for(page, "document.querySelector('[data-name=turtle1]') !== null")
    return page


def colour_at(page: Page, x: float, y: float) -> tuple[int, ...]:
    """Return what a person sees there, in pixels of the picture."""
    box = page.locator('#frame').bounding_box()
    assert box is not None
    pixels = pixels_of(page.screenshot())
    scale = box['width'] / 500
    row, column = int(box['y'] + y * scale), int(box['x'] + x * scale)
    return tuple(int(value) for value in pixels[row, column])


def test_a_browser_shows_turtles_and_lines(
    address: str, student: TurtleClient, browser: Browser
) -> None:
    page = open_page(browser, address)
    assert page.title() == 'TurtleSim'
    assert colour_at(page, 20, 20) == BLUE
    assert colour_at(page, 249, 252) not in (BLUE, PEN)  # the turtle's shell
    student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=9.0, y=5.544445, theta=1.0)
    wait_until(
        lambda: colour_at(page, 249, 250) == PEN, timeout_sec=20.0, what='the line of the teleport'
    )
    transform = page.locator('[data-name=turtle1]').get_attribute('transform') or ''
    assert [float(word) for word in re.findall(r'[-\d.]+', transform)] == pytest.approx(
        [405.0, 249.5, -57.296], abs=0.01
    )
    student.call(Kill, 'kill', name='turtle1')
    wait_for(page, "document.querySelector('[data-name]') === null")
    assert colour_at(page, 249, 250) == PEN
    assert errors(page) == []


@pytest.mark.usefixtures('default_parameters')
def test_the_background_is_that_of_the_parameters(
    address: str, student: TurtleClient, browser: Browser
) -> None:
    page = open_page(browser, address)
    parameters = [
        Parameter(f'background_{letter}', value=value).to_parameter_msg()
        for letter, value in (('r', 150), ('g', 20), ('b', 30))
    ]
    student.call(SetParameters, 'turtlesim/set_parameters', parameters=parameters)
    wait_until(
        lambda: colour_at(page, 20, 20) == (150, 20, 30), timeout_sec=20.0, what='the new colour'
    )
    student.call(Empty, 'clear')
    assert colour_at(page, 20, 20) == (150, 20, 30)


def test_two_pages_and_a_phone_show_the_same(
    address: str, student: TurtleClient, browser: Browser
) -> None:
    pages = [open_page(browser, address), open_page(browser, address, 320, 480)]
    student.call(SetPen, 'turtle1/set_pen', r=255, g=255, width=20)
    student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=9.0, y=9.0)
    wait_until(
        lambda: all(colour_at(page, 327, 172) == (255, 255, 0) for page in pages),
        timeout_sec=20.0,
        what='the line on each page',
    )
    fits = 'document.documentElement.scrollWidth <= innerWidth'
    assert all(page.evaluate(fits) for page in pages)


def test_tabs_behind_another_leave_their_connection_to_it(
    address: str, student: TurtleClient, browser: Browser
) -> None:
    with browser.new_context() as one_browser:  # which has six connections to a server
        tabs = []
        for _ in range(8):
            tabs.append(one_browser.new_page())
            tabs[-1].goto(address)
            wait_for(tabs[-1], "document.querySelector('[data-name=turtle1]') !== null")
            hide(tabs[-1])
        student.call(Spawn, 'spawn', name='later')
        hide(tabs[0], hidden=False)
        wait_for(tabs[0], "document.querySelector('[data-name=later]') !== null")
        assert tabs[0].inner_text('#status') == ''
        assert tabs[1].locator('[data-name=later]').count() == 0


@pytest.mark.usefixtures('own_domain')
def test_a_page_goes_on_with_the_next_turtlesim(processes: Processes, browser: Browser) -> None:
    turtlesim = start(processes)
    address = address_of(turtlesim)
    page = open_page(browser, address)
    turtlesim.close()
    wait_for(page, "document.getElementById('status').className === 'lost'")
    assert 'turtlesim has ended' in page.inner_text('#status')
    # As who forwards a port at which nobody listens: VS Code does.
    page.route('**/events', lambda route: route.fulfill(status=502))
    for _ in range(2):
        page.wait_for_event('response', lambda answer: answer.status == 502, timeout=20_000)
    page.unroute('**/events')
    start(processes, '--port', str(urlsplit(address).port))
    wait_for(page, "document.getElementById('status').className === ''")
    assert page.locator('[data-name=turtle1]').count() == 1


def test_names_of_turtles_are_text(address: str, student: TurtleClient, browser: Browser) -> None:
    page = open_page(browser, address)
    assert student.call(Spawn, 'spawn', name='deep/er').name == 'deep/er'
    wait_for(page, 'document.querySelector(\'[data-name="deep/er"] title\') !== null')
    assert page.locator('[data-name="deep/er"] title').text_content() == 'deep/er'


def test_the_picture_of_the_documentation(
    address: str, student: TurtleClient, browser: Browser
) -> None:
    """Draw what docs/turtlesim.md shows; PLAYPEN_PICTURES is the folder it is kept in."""
    page = open_page(browser, address, 500, 530)
    student.call(Spawn, 'spawn', x=2.5, y=8.5, theta=-0.6, name='turtle2')
    student.call(SetPen, 'turtle2/set_pen', r=255, g=196, b=0, width=5)
    for turtle, turn in (('turtle1', 1.8), ('turtle2', 0.9)):
        student.command(turtle, x=2.0, turn=turn)
    student.wait_for_pose(lambda pose: pose.linear_velocity > 0, 'a turtle that goes', 'turtle2')
    for turtle in ('turtle1', 'turtle2'):
        student.wait_for_pose(lambda pose: pose.linear_velocity == 0, 'its end', turtle)
    wait_until(
        lambda: len(np.unique(pixels_of(page.screenshot()).reshape(-1, 3), axis=0)) > 20,
        timeout_sec=20.0,
        what='a picture of many colours',
    )
    if KEPT:
        keep_still(page, Path(KEPT) / 'turtlesim.png')


def asked(address: str, path: str = '/', method: str = 'GET', **headers: str) -> int:
    """Return the status of an answer."""
    connection = http.client.HTTPConnection(urlsplit(address).netloc, timeout=10.0)
    try:
        connection.request(method, path, headers=headers)
        return connection.getresponse().status
    finally:
        connection.close()


def test_hostile_requests_are_refused(address: str) -> None:
    requests: tuple[tuple[int, str, str, dict[str, str]], ...] = (
        (200, '/', 'GET', {'Host': 'localhost:9'}),
        (421, '/', 'GET', {'Host': 'evil.example'}),
        (421, '/events', 'GET', {'Host': 'evil.example:8110'}),
        (421, '/', 'GET', {'Host': '127.0.0.1.evil.example'}),
        (421, '/', 'GET', {'Host': '[::'}),
        (403, '/events', 'GET', {'Origin': 'http://evil.example'}),
        (403, '/events', 'GET', {'Origin': 'null'}),
        (404, '/../../etc/passwd', 'GET', {}),
        (404, '/page.html', 'GET', {}),
        (501, '/', 'POST', {}),
        (501, '/events', 'OPTIONS', {}),
        (431, '/', 'GET', {'X-Long': 'x' * 70_000}),
    )
    for status, path, method, headers in requests:
        assert asked(address, path, method, **headers) == status, (path, method, headers)
        assert asked(address) == 200, (path, method, headers)


def listening(process: Process) -> list[tuple[str, int]]:
    """Return where a process and its children wait for connections."""
    started = psutil.Process(process.pid)
    return [
        tuple(connection.laddr)
        for each in (started, *started.children(recursive=True))
        for connection in each.net_connections('tcp')
        if connection.status == psutil.CONN_LISTEN
    ]


def test_the_page_is_of_this_computer_alone_and_says_little(
    turtlesim: Process, address: str
) -> None:
    port = urlsplit(address).port or 0
    assert listening(turtlesim) == [('127.0.0.1', port)]
    before = len(turtlesim.lines)
    for data in (b'\x00\xff\r\n\r\n', b'GET\r\n\r\n', b'GET / HTTP/9.9\r\n\r\n', b''):
        with socket.create_connection(('127.0.0.1', port)) as raw:
            raw.sendall(data)
    assert asked(address) == 200
    assert turtlesim.lines[before:] == []


def test_a_page_that_does_not_read_holds_nobody_up(address: str, student: TurtleClient) -> None:
    with socket.create_connection(('127.0.0.1', urlsplit(address).port or 0)) as raw:
        raw.sendall(b'GET /events HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n')
        for number in range(10):
            student.call(SetPen, 'turtle1/set_pen', r=number, width=255)
            for x in (0.0, 11.0):
                student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=x, y=11.0 - x)
        with events_of(address) as events:
            assert events.next()['turtles'][0][0] == 'turtle1'


@pytest.mark.usefixtures('own_domain')
def test_ports_are_the_next_free_one_or_the_one_asked_for(
    processes: Processes, shared_address: str
) -> None:
    address = shared_address
    assert address_of(start(processes)) != address
    port = str(urlsplit(address).port)
    refused = processes.start(*NODE, '--port', port)
    assert refused.wait() != 0
    assert f'turtlesim_node: --port {port} is taken: leave it out to get a free one' in (
        refused.lines
    )


@pytest.mark.usefixtures('own_domain')
@pytest.mark.parametrize('how', ['option', 'variable'])
def test_graders_have_no_page(
    processes: Processes, monkeypatch: pytest.MonkeyPatch, how: str
) -> None:
    if how == 'variable':
        monkeypatch.setenv('QT_QPA_PLATFORM', 'offscreen')
    words = ('-platform', 'offscreen') if how == 'option' else ()
    node = processes.start(*NODE, *words)
    node.wait_for_text('Spawning turtle')
    with TurtleClient() as student:
        assert student.pose().x > 5.0
    assert listening(node) == []
    assert 'http' not in node.output


@pytest.mark.usefixtures('own_domain')
def test_a_browser_is_opened_on_a_desktop_alone(
    processes: Processes, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    browser = tmp_path / 'browser'
    browser.write_text(f'#!/bin/sh\necho "$1 $LD_LIBRARY_PATH" >> {tmp_path}/opened\n')
    browser.chmod(0o755)
    monkeypatch.setenv('BROWSER', str(browser))
    start(processes)
    monkeypatch.setenv('DISPLAY', ':99')
    address = address_of(start(processes))
    opened = tmp_path / 'opened'
    wait_until(opened.is_file, timeout_sec=20.0, what='a page that is opened')
    wait_until(lambda: opened.read_text().endswith('\n'), timeout_sec=5.0, what='its line')
    told, _, libraries = opened.read_text().strip().partition(' ')
    assert told == address
    assert sys.prefix not in libraries
