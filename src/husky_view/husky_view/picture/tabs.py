# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What happens in the tabs of a page, told to what the page shows."""

import asyncio
from collections.abc import Callable

import viser


class Tabs:
    """
    Calls what is shown when a tab's camera has moved, or a tab is gone.

    viser keeps a callback, and all that belongs to it, for as long as it serves: it gets these
    alone, once, and what is shown is forgotten with the page. Calls come from the server's thread.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._on_camera: list[Callable[[viser.CameraHandle], object]] = []
        self._on_gone: list[Callable[[int], object]] = []
        self._server_loop: asyncio.AbstractEventLoop | None = None  # known with the first tab

        @server.on_client_connect
        async def _(client: viser.ClientHandle) -> None:
            self._server_loop = asyncio.get_running_loop()
            client.camera.on_update(self._tell_camera)

        @server.on_client_disconnect
        async def _(client: viser.ClientHandle) -> None:
            for tell in tuple(self._on_gone):
                tell(client.client_id)

    async def _tell_camera(self, camera: viser.CameraHandle) -> None:
        for tell in tuple(self._on_camera):
            tell(camera)

    def between_reports(self, change: Callable[[], None]) -> None:
        """
        Change the camera of a tab soon, in the server's thread; from any thread.

        viser puts what a tab reports in the place of the camera that it knows, at any time. Amid a
        change, which needs that one, the tab would be told of a camera that looks elsewhere.
        """
        assert self._server_loop is not None, 'no tab has come yet'
        self._server_loop.call_soon_threadsafe(change)

    def on_camera(self, tell: Callable[[viser.CameraHandle], object]) -> None:
        """Call this with the camera of a tab that reports it."""
        self._on_camera.append(tell)

    def on_gone(self, tell: Callable[[int], object]) -> None:
        """Call this with the number of a tab that is gone."""
        self._on_gone.append(tell)

    def clear(self) -> None:
        """Call nothing any more of what was shown so far."""
        self._on_camera.clear()
        self._on_gone.clear()
