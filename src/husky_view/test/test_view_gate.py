# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The gate: who is let to the page, and what of what a page sends."""

from collections.abc import Iterator
from contextlib import ExitStack, suppress
from functools import partial
from http import HTTPStatus
import logging
import math
from queue import SimpleQueue
import socket
import time
from typing import Any
import urllib.error
import urllib.request

from husky_view.gate.admission import Admission
from husky_view.gate.front_page import ALIVE
from husky_view.gate.gate import (
    BURST,
    Gate,
    MOST_BYTES,
    MOST_CONNECTIONS,
    MOST_FRAMES,
    MOST_TABS,
    MOST_UNREAD_BYTES,
)
from husky_view.server import close_server, PageServer
from msgspec.msgpack import encode
from playpen_testing.page_client import CAMERA, stalled_tab
from playpen_testing.waiting import wait_until
import pytest
import viser
from websockets.asyncio import server
from websockets.exceptions import ConnectionClosed, InvalidStatus, WebSocketException
from websockets.frames import Frame, Opcode
from websockets.sync.client import connect
from websockets.sync.connection import Connection
from websockets.typing import Subprotocol

TOKEN = 'xyz-xyz-xyz'
HERE = 'localhost:8080'
FORBIDDEN, MISDIRECTED = HTTPStatus.FORBIDDEN, HTTPStatus.MISDIRECTED_REQUEST


@pytest.mark.parametrize(
    ('path', 'hosts', 'origins', 'status'),
    [
        (f'/{TOKEN}/', [HERE], [], None),
        (f'/{TOKEN}', [HERE], [f'http://{HERE}'], None),
        (f'/{TOKEN}/?darkMode', ['127.0.0.1:8080'], [], None),
        (f'/{TOKEN}', ['[::1]:8080'], ['http://[::1]:8080'], None),
        (f'/{TOKEN}', ['localhost:9000'], ['http://localhost:9000'], None),  # ssh -L
        (f'/{TOKEN}', ['lab.example'], ['https://lab.example'], None),  # allowed
        (f'/{TOKEN}', [HERE], ['https://lab.example'], None),  # by a proxy that is allowed
        ('/', [HERE], [], FORBIDDEN),
        (f'/{TOKEN}x', [HERE], [], FORBIDDEN),
        (f'/{TOKEN[:-1]}', [HERE], [], FORBIDDEN),
        (f'/?token={TOKEN}', [HERE], [], FORBIDDEN),
        ('/\udcff', [HERE], [], FORBIDDEN),
        (f'/{TOKEN}', [HERE], ['http://evil.example'], FORBIDDEN),
        (f'/{TOKEN}', [HERE], ['http://localhost:3000'], FORBIDDEN),
        (f'/{TOKEN}', [HERE], ['null'], FORBIDDEN),
        (f'/{TOKEN}', [HERE], 2 * [f'http://{HERE}'], FORBIDDEN),
        ('', [HERE], [], FORBIDDEN),
        (f'/{TOKEN}', [HERE], [f'http://{HERE}', 'http://evil.example'], FORBIDDEN),
        (f'/{TOKEN}', [HERE], ['http://lab.example.evil.example'], FORBIDDEN),
        (f'/{TOKEN}', [HERE], ['http://lab.example@evil.example'], FORBIDDEN),
        (f'/{TOKEN}', ['evil.example:8080'], ['http://evil.example:8080'], MISDIRECTED),
        (f'/{TOKEN}', ['localhost.evil.example'], [], MISDIRECTED),
        (f'/{TOKEN}', ['localhost@evil.example'], [], MISDIRECTED),
        (f'/{TOKEN}', ['evil.example@localhost'], [], MISDIRECTED),
        (f'/{TOKEN}', ['localhost/evil.example'], [], MISDIRECTED),
        (f'/{TOKEN}', ['127.0.0.1.evil.example'], [], MISDIRECTED),
        (f'/{TOKEN}', ['[::1'], [], MISDIRECTED),
        (f'/{TOKEN}', [HERE, 'evil.example'], [], MISDIRECTED),
        (f'/{TOKEN}', [], [], MISDIRECTED),
    ],
)
def test_only_the_page_with_its_token_is_admitted(
    path: str, hosts: list[str], origins: list[str], status: HTTPStatus | None
) -> None:
    refusal = Admission(TOKEN, host='127.0.0.1', names=['Lab.Example']).refusal(
        path, hosts, origins
    )
    assert (refusal and refusal.status) == status


def test_a_name_with_more_than_a_name_is_refused() -> None:
    with pytest.raises(ValueError, match=r"^'http://lab' is no name .* without http"):
        Admission(TOKEN, host='127.0.0.1', names=['http://lab'])


FORGED: tuple[object, ...] = ([], True)


class Page:
    """A page with one control of each kind, and what it heard from them."""

    def __init__(self) -> None:
        with socket.socket() as free:
            free.bind(('127.0.0.1', 0))
            self.port = free.getsockname()[1]
        self.server = PageServer('127.0.0.1', self.port, title='Tried <here>')
        gui = self.server.gui
        self.controls = {
            'button': gui.add_button('button'),
            'grey': gui.add_button('grey', disabled=True),
            'hidden': gui.add_button('hidden', visible=False),
            'group': gui.add_button_group('group', ('a', 'b')),
            'list': gui.add_dropdown('list', ('a', 'b')),
            'slider': gui.add_slider('slider', 0.0, 1.0, 0.1, 0.5),
            'box': gui.add_checkbox('box', False),
            'text': gui.add_text('text', 'a'),
            'number': gui.add_number('number', 1.0),  # no page of ours has one
        }
        self._heard: SimpleQueue[tuple[str, Any]] = SimpleQueue()
        for name, control in self.controls.items():
            listen = getattr(control, 'on_click', None) or control.on_update
            listen(self._hearer(name))
        self.websocket = self.server.address.replace('http', 'ws').rstrip('/')

    def _hearer(self, name: str) -> Any:
        async def hear(event: viser.GuiEvent[Any]) -> None:
            self._heard.put((name, event.target.value))

        return hear

    def connect(self, **options: Any) -> Connection:
        spoken = [Subprotocol(f'viser-v{viser.__version__}')]
        return connect(self.websocket, **{'subprotocols': spoken, 'max_size': None, **options})

    def has_room(self) -> bool:
        """Tell whether a tab that comes now is let in."""
        try:
            self.connect().close()
        except (ConnectionError, WebSocketException):
            return False
        return True

    def heard_after(self, *messages: object) -> list[tuple[str, Any]]:
        """Send messages by a tab of their own; return what was heard of them."""
        with self.connect() as tab:
            tab.send(encode(CAMERA))
            for message in messages:
                raw = message if isinstance(message, (str, bytes)) else encode(message)
                tab.send(raw)
            return self.heard_before_a_click(tab)

    def heard_before_a_click(self, tab: Connection) -> list[tuple[str, Any]]:
        """Click on the button; return what was heard before."""
        tab.send(self.update('button', value=True))
        return list(iter(partial(self._heard.get, timeout=10.0), ('button', True)))

    def update(self, name: str, **updates: object) -> bytes:
        uuid = self.controls[name]._impl.uuid
        return encode({'type': 'GuiUpdateMessage', 'uuid': uuid, 'updates': updates})


@pytest.fixture(scope='module')
def page() -> Iterator[Page]:
    opened = Page()
    yield opened
    close_server(opened.server)


def test_a_control_takes_what_it_offers(page: Page) -> None:
    values: dict[str, object] = {
        'group': 'b',
        'list': 'b',
        'slider': 1,
        'box': True,
        'text': 'my path',
    }
    messages = [page.update(name, value=value) for name, value in values.items()]
    assert dict(page.heard_after(*messages)) == values


def test_a_page_is_heard_before_it_has_told_of_its_camera(page: Page) -> None:
    checked = not page.controls['box'].value
    with page.connect() as tab:
        tab.send(page.update('box', value=checked))
        assert page.heard_before_a_click(tab) == [('box', checked)]
        wait_until(  # viser forgets a tab of the test before as late as that suits it
            lambda: len(page.server.get_clients()) == 1, timeout_sec=10.0, what='this tab alone'
        )
        (client,) = page.server.get_clients().values()
        tab.send(encode({**CAMERA, 'image_width': 321}))
        wait_until(
            lambda: client.camera.image_width == 321, timeout_sec=10.0, what='its own camera'
        )
        assert page.heard_before_a_click(tab) == []
        assert client.camera.image_width == 321, 'another camera went ahead of the click'


NOT_OFFERED: dict[str, list[object]] = {
    'button': [False, 1, 'x', None, [], {}],
    'grey': [True],
    'hidden': [True],
    'group': ['zzz', 0, True, ['a'], 'A'],
    'list': ['../../etc/passwd', '', 1, None],
    'slider': [-0.1, 1.1, math.nan, math.inf, '0.5', True, 2**63],
    'box': [1, 'true', None],
    'text': [1, 'a\nb', 'a\x00', 'a' * 201],
    'number': [2.0],
}


@pytest.mark.parametrize(
    ('name', 'value'), [(name, value) for name in NOT_OFFERED for value in NOT_OFFERED[name]]
)
def test_a_value_that_a_control_does_not_offer_is_dropped(
    page: Page, name: str, value: object
) -> None:
    before = page.controls[name].value
    assert page.heard_after(page.update(name, value=value)) == []
    assert page.controls[name].value == before


def test_what_the_server_sets_no_page_can(page: Page) -> None:
    kept = {
        name: {**vars(control._impl), **vars(control._impl.props)}
        for name, control in page.controls.items()
    }
    forged = [
        page.update(name, **{**offered, field: value})
        for name, fields in kept.items()
        for field in fields
        if field != 'value'
        for value in FORGED
        for offered in ({}, {'value': page.controls[name].value})  # with what it may send, too
    ]
    both = page.update('group', value='a', options=['zzz'])
    assert page.heard_after(both, *forged) == []
    for name, fields in kept.items():
        control = page.controls[name]
        now = {**vars(control._impl), **vars(control._impl.props)}
        changed = {key for key in fields if fields[key] is not now[key]}
        assert changed <= {'value', 'update_timestamp'}, name


def test_every_other_message_of_viser_is_dropped(
    page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken = {
        'ViewerCameraMessage',
        'GuiUpdateMessage',
        'GuiButtonHoldMessage',
        'ScenePointerMessage',
        'SceneNodeDragMessage',
    }
    arrived = list[object]()
    handle = page.server._websock_server._handle_incoming_message

    async def taken_in(client: Any, message: Any) -> None:
        arrived.append(type(message).__name__)
        await handle(client, message)

    monkeypatch.setattr(page.server._websock_server, '_handle_incoming_message', taken_in)
    kinds = {each.__name__ for each in viser._messages.Message.get_subclasses()}
    assert taken < kinds, 'the names are those of viser'
    page.heard_after(*({'type': kind} for kind in kinds), {'type': 'ShareUrlRequest'})
    assert set(arrived) == {'ViewerCameraMessage', 'GuiUpdateMessage'}, 'the two of a real page'


def test_garbage_leaves_the_tab_connected(page: Page) -> None:
    deep = b'\x91' * (MOST_BYTES - 1) + b'\x90'
    broken = [b'', b'\xc1', b'\xdd\xff\xff\xff\xff', deep, 'text', [], 1, {}, {'type': 1}]
    assert page.heard_after(*broken, {**CAMERA, 'position': [1e300, 0, 0]}) == []


def test_a_message_too_long_ends_the_connection(page: Page) -> None:
    with page.connect() as tab:
        tab.send(b'\x00' * (MOST_BYTES + 1))
        with pytest.raises(ConnectionClosed, match='too big'):
            list(tab)


def test_a_message_in_many_frames_ends_the_connection(page: Page) -> None:
    with page.connect() as tab:
        tab.send(encode(CAMERA))
        update = page.update('slider', value=0.8)
        tab.send([update[:9], update[9:]])
        assert page.heard_before_a_click(tab) == [('slider', 0.8)]
        with suppress(ConnectionClosed):
            tab.send(b'' for _ in range(2 * MOST_FRAMES))
        with pytest.raises(ConnectionClosed):
            list(iter(partial(tab.recv, timeout=10.0), None))


def test_a_tab_that_asks_and_never_reads_is_left(page: Page) -> None:
    with page.connect() as other, stalled_tab(page.server.address) as tab:
        tab.settimeout(10.0)
        ping = Frame(Opcode.PING, b'x' * 125).serialize(mask=True)
        with pytest.raises(ConnectionError):  # the kernel keeps some megabytes, too
            tab.sendall(ping * (3 * MOST_UNREAD_BYTES // len(ping)))
        other.send(encode(CAMERA))
        assert page.heard_before_a_click(other) == []


def warnings(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return what would be printed: other tests may have had logging keep more."""
    return [each.getMessage() for each in caplog.records if each.levelno >= logging.WARNING]


def test_another_version_of_the_page_is_refused_in_silence(
    page: Page, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    for spoken in ['viser-v0.1'], None:
        with pytest.raises(InvalidStatus) as refused:
            page.connect(subprotocols=spoken)
        assert refused.value.response.status_code == HTTPStatus.BAD_REQUEST
    assert (capfd.readouterr(), warnings(caplog)) == (('', ''), [])


def test_tabs_beyond_the_last_place_are_refused(page: Page) -> None:
    tabs = [page.connect() for _ in range(MOST_TABS)]
    try:
        with pytest.raises(InvalidStatus) as refused:
            page.connect()
        assert refused.value.response.status_code == HTTPStatus.SERVICE_UNAVAILABLE
    finally:
        for tab in tabs:
            tab.close()
    assert page.heard_after() == [], 'there is room again'


def test_connections_that_say_nothing_do_not_disturb_a_tab(page: Page) -> None:
    with ExitStack() as strangers, page.connect() as tab:
        for _ in range(MOST_CONNECTIONS + 20):
            strangers.enter_context(socket.create_connection(('127.0.0.1', page.port)))
        tab.send(encode(CAMERA))
        tab.send(page.update('slider', value=0.9))
        assert page.heard_before_a_click(tab) == [('slider', 0.9)]
    wait_until(page.has_room, timeout_sec=10.0, what='room, when the strangers have left')


def test_a_flood_of_one_tab_waits_and_another_tab_does_not(
    page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr('husky_view.gate.gate.RATE_HZ', 1.0)  # longer than it takes to look
    begin_sec = time.monotonic()
    with page.connect() as flood:
        flood.send(encode(CAMERA))
        for _ in range(BURST):
            flood.send(page.update('slider', value=0.3))
            flood.send(page.update('slider', value=0.6))
        heard = page.heard_after()
        assert len(heard) < 2 * BURST, 'the flood was over before the other tab was heard'
        while len(heard) < BURST - 1:  # its camera is one of the first
            heard += page.heard_after()
        heard += [each for _ in range(5) for each in page.heard_after()]
        assert len(heard) <= BURST + time.monotonic() - begin_sec, 'the flood did not wait'
        monkeypatch.setattr('husky_view.gate.gate.RATE_HZ', 1e6)
        heard += page.heard_before_a_click(flood)  # nothing is left for the tests after this
    assert len(heard) == 2 * BURST


def test_no_page_is_served_that_does_not_come_by_the_gate() -> None:
    gate, before = Gate(Admission(TOKEN, host='127.0.0.1'), title='Tried'), server.serve
    refused = pytest.raises(RuntimeError, match='nothing would be checked')
    with refused, gate.in_front():
        assert server.serve != before
    assert server.serve is before


def test_the_page_has_its_title_and_asks_for_no_other_file(page: Page) -> None:
    with urllib.request.urlopen(page.server.address, timeout=10.0) as answer:
        assert '<title>Tried &lt;here&gt;</title>' in answer.read().decode()
        assert answer.headers['Referrer-Policy'] == 'no-referrer'
    with pytest.raises(urllib.error.HTTPError, match='404') as missing:
        urllib.request.urlopen(f'{page.server.address}../index.html/x', timeout=10.0)
    missing.value.close()
    with urllib.request.urlopen(f'{page.server.address}{ALIVE}', timeout=10.0) as answer:
        assert (answer.status, answer.read()) == (204, b'')
    for path in ('', ALIVE, f'x/{ALIVE}'):
        with pytest.raises(urllib.error.HTTPError, match='403') as refused:
            urllib.request.urlopen(f'http://127.0.0.1:{page.port}/{path}', timeout=10.0)
        with refused.value as answer:
            assert b'the terminal' in answer.read()


REQUEST = b'GET / HTTP/1.1\r\nHost: localhost\r\n\r\n'


# Pytest takes what is logged before it gets to the terminal.
@pytest.mark.parametrize('sent', [b'\x16\x03\x01 no request\r\n\r\n', 2 * REQUEST])
def test_no_request_or_more_than_one_says_nothing_in_the_terminal(
    page: Page, sent: bytes, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    with socket.create_connection(('127.0.0.1', page.port)) as stranger:
        stranger.sendall(sent)
        while stranger.recv(1000):
            pass
        assert page.heard_after() == []  # before this end is closed
    assert (capfd.readouterr(), warnings(caplog)) == (('', ''), [])
