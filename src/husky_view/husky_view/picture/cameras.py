# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where each tab looks from: behind a robot and with it, from above, or as its person likes."""

import contextlib
import math

import numpy as np
import numpy.typing as npt
import viser

from husky_view.picture.chase import Chase

Array = npt.NDArray[np.float64]

FREE, FOLLOW, TOP = 'Free', 'Follow', 'Top'
PRESETS = (FREE, FOLLOW, TOP)

BACK_M, UP_M = 3.8, 2.4
"""From where a camera follows."""


class Cameras:
    """The cameras of all tabs."""

    def __init__(self, server: viser.ViserServer, *, center: Array, extent_m: float) -> None:
        self._server = server
        self._center = center
        self._extent_m = extent_m
        self._chases: dict[int, Chase] = {}  # by client
        server.initial_camera.position = center + extent_m * np.array([-0.85, -0.75, 0.75])
        server.initial_camera.look_at = center
        server.initial_camera.fov = math.radians(50.0)

        @server.on_client_connect
        async def _(client: viser.ClientHandle) -> None:
            client.camera.on_update(self._on_camera)

        @server.on_client_disconnect
        async def _(client: viser.ClientHandle) -> None:
            self._chases.pop(client.client_id, None)

    async def _on_camera(self, camera: viser.CameraHandle) -> None:
        chase = self._chases.get(camera.client.client_id)
        if chase is not None:
            chase.report(camera.position - camera.look_at)

    def choose(
        self,
        client: viser.ClientHandle,
        preset: str,
        *,
        robot: Array,
        yaw: float,
        now_sec: float,
    ) -> None:
        """Bring the camera of a tab to a preset; robot is where it may have to follow."""
        self._chases.pop(client.client_id, None)
        if preset == FOLLOW:
            behind = np.array([-BACK_M * math.cos(yaw), -BACK_M * math.sin(yaw), UP_M])
            self._look(client, robot + behind, robot)
            self._chases[client.client_id] = Chase(robot, behind, now_sec=now_sec)
        elif preset == TOP:
            # 1.15: the whole playpen, on wide and on narrow screens
            narrow = max(1.0, client.camera.image_height / max(client.camera.image_width, 1))
            height = 1.15 * self._extent_m * narrow / math.tan(client.camera.fov / 2.0)
            # not quite from above, or there would be no telling which way is up
            self._look(
                client, self._center + np.array([0.0, -0.01 * height, height]), self._center
            )

    def _look(self, client: viser.ClientHandle, position: Array, at: Array) -> None:
        # viser refuses a camera that looks straight up or down.
        with contextlib.suppress(ValueError), client.atomic():
            client.camera.position = position
            client.camera.look_at = at
        client.flush()

    def follow(self, robot: Array, *, now_sec: float) -> None:
        """Take the cameras that follow on to where the robot is now; call it every frame."""
        clients = self._server.get_clients() if self._chases else {}
        for client_id, chase in list(self._chases.items()):
            client = clients.get(client_id)
            if client is not None and chase.step(robot, now_sec=now_sec):
                self._look(client, chase.at + chase.offset, chase.at)
