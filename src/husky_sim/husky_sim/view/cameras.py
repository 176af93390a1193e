# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where each tab looks from: behind a robot and with it, from above, or as its person likes."""

import contextlib
import math

import numpy as np
import numpy.typing as npt
import viser

Array = npt.NDArray[np.float64]

FREE, FOLLOW, TOP = 'Free', 'Follow', 'Top'
PRESETS = (FREE, FOLLOW, TOP)

_MOVED_M = 0.002


class Cameras:
    """The cameras of all tabs."""

    def __init__(self, server: viser.ViserServer, *, center: Array, extent_m: float) -> None:
        self._server = server
        self._center = center
        self._extent_m = extent_m
        self._following: dict[int, Array] = {}  # by client: where it looks
        server.initial_camera.position = center + extent_m * np.array([-0.85, -0.75, 0.75])
        server.initial_camera.look_at = center
        server.initial_camera.fov = math.radians(50.0)

        @server.on_client_disconnect
        def _(client: viser.ClientHandle) -> None:
            self._following.pop(client.client_id, None)

    def choose(self, client: viser.ClientHandle, preset: str, *, robot: Array, yaw: float) -> None:
        """Bring the camera of a tab to a preset; robot is where it may have to follow."""
        self._following.pop(client.client_id, None)
        if preset == FOLLOW:
            behind = np.array([-3.0 * math.cos(yaw), -3.0 * math.sin(yaw), 1.9])
            self._look(client, robot + behind, robot)
            self._following[client.client_id] = robot
        elif preset == TOP:
            # 1.15: the whole playpen, on wide and on narrow screens
            narrow = max(1.0, client.camera.image_height / max(client.camera.image_width, 1))
            height = 1.15 * self._extent_m * narrow / math.tan(client.camera.fov / 2.0)
            # not quite from above, or there would be no telling which way is up
            self._look(
                client, self._center + np.array([0.0, -0.01 * height, height]), self._center
            )

    def _look(self, client: viser.ClientHandle, position: Array, at: Array) -> None:
        with client.atomic():
            client.camera.position = position
            client.camera.look_at = at

    def follow(self, robot: Array) -> None:
        """Take the cameras that follow to where the robot is now; call it with every frame."""
        clients = self._server.get_clients() if self._following else {}
        for client_id, before in list(self._following.items()):
            client = clients.get(client_id)
            if client is None or float(np.abs(robot - before).max()) < _MOVED_M:
                continue
            camera = client.camera
            # Only the difference counts, since it is the same however old the pose is that the
            # page told last; so a person may turn and zoom while the camera follows.
            away = np.array(camera.position) - np.array(camera.look_at)
            with contextlib.suppress(ValueError):
                self._look(client, robot + away, robot)
            self._following[client_id] = robot
