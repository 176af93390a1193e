# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A client that speaks to the view as its page does, without a browser."""

from importlib.metadata import version
import socket
from typing import Any
from urllib.parse import urlsplit

import msgspec
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol
import zstandard

CAMERA = {
    'type': 'ViewerCameraMessage',
    'wxyz': [1, 0, 0, 0],
    'position': [0.0, 0.0, 5.0],
    'fov': 1.0,
    'near': 0.01,
    'far': 1000,
    'image_height': 100,
    'image_width': 100,
    'look_at': [0, 0, 0],
    'up_direction': [0, 0, 1],
}
"""The first message of a page: with it, viser has a new tab."""


_PROTOCOL = Subprotocol(f'viser-v{version("viser")}')


def stalled_tab(address: str) -> socket.socket:
    """Open the page's websocket, and never read from it."""
    url = urlsplit(address)
    tab = socket.create_connection((url.hostname, url.port or 0))
    tab.sendall(
        (
            f'GET {url.path} HTTP/1.1\r\nHost: localhost\r\n'
            'Upgrade: websocket\r\nConnection: Upgrade\r\n'
            'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n'
            f'Sec-WebSocket-Protocol: {_PROTOCOL}\r\n\r\n'
        ).encode()
    )
    assert b'101 Switching' in tab.recv(200), 'no websocket'
    return tab


class PageClient:
    """
    A tab of the view.

    :param address: as the view has printed it.
    """

    def __init__(self, address: str) -> None:
        self._tab: ClientConnection = connect(
            address.replace('http://', 'ws://').rstrip('/'),
            subprotocols=[_PROTOCOL],
            max_size=None,
            close_timeout=0.1,
        )
        self.controls: dict[str, dict[str, Any]] = {}  # as viser has described them, by label
        self.looked_at: list[list[float]] = []  # to what its camera was turned
        self.places: dict[str, list[float]] = {}  # of what stands in the scene, by name
        self.send(CAMERA)

    def __enter__(self) -> 'PageClient':
        return self

    def __exit__(self, *_: object) -> None:
        self._tab.close()

    def send(self, message: object) -> None:
        """Send a message, or bytes as they are."""
        raw = message if isinstance(message, bytes) else msgspec.msgpack.encode(message)
        self._tab.send(raw)

    def set(self, label: str, value: object) -> None:
        """Set a control, or click on it."""
        uuid = self.control(label)['uuid']
        self.send({'type': 'GuiUpdateMessage', 'uuid': uuid, 'updates': {'value': value}})

    def control(self, label: str) -> dict[str, Any]:
        """Return what viser says of a control; waits for it."""
        while label not in self.controls:
            self.read()
        return self.controls[label]

    def read(self) -> None:
        """Wait for messages and register what they say of controls, places and the camera."""
        raw = self._tab.recv(timeout=20.0)
        assert isinstance(raw, bytes)
        size, length = (int.from_bytes(raw[at : at + 8], 'little') for at in (0, 8))
        inner = zstandard.ZstdDecompressor().decompress(raw[16 : 16 + length], size)
        for message in msgspec.msgpack.decode(inner)['messages']:
            if 'uuid' in message and 'label' in message.get('props', {}):
                self.controls[message['props']['label']] = message
            elif message['type'] == 'GuiUpdateMessage':
                self._update(message['uuid'], message['updates'])
            elif message['type'] == 'SetPositionMessage':
                self.places[message['name']] = message['position']
            elif message['type'] == 'SetCameraLookAtMessage':
                self.looked_at.append(message['look_at'])

    def _update(self, uuid: str, updates: dict[str, Any]) -> None:
        for label, control in list(self.controls.items()):
            if control['uuid'] == uuid:
                control['props'].update(updates)
                self.controls[control['props']['label']] = self.controls.pop(label)
