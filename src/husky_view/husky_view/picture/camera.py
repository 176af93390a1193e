# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The camera of each tab: free, following a robot, or looking down on the playpen."""

from collections.abc import Callable
import contextlib
import math
from typing import Any

from husky_course.frames import Array
import numpy as np
import viser

from husky_view.picture.clicks import in_order
from husky_view.picture.geometry import Bounds
from husky_view.picture.page import FOLLOW, PRESETS, TOP
from husky_view.picture.tabs import Tabs

BACK_M, UP_M = 3.8, 2.4
"""Offset of a following camera from the robot, in the beginning."""

TIME_CONSTANT_SEC = 0.15
"""Of the low-pass filter by which a following camera approaches the robot."""

USER_PAUSE_SEC = 0.3
"""A following camera stands so long after a person turned or zoomed it."""

DELIVERY_SEC = 2.0
"""A pose reaches the page within this time, also on a busy computer."""

REPORT_TIMEOUT_SEC = 0.2
"""The next pose is sent when the page has reported the last one, or after this time: a pose sent
earlier would override unseen what a person does meanwhile."""

PANEL_PX, PHONE_PX = 340, 576
"""What the panel hides on the right, if the page is wider than a phone's."""

TOP_MARGIN = 1.08
"""What is seen from above, of what there is."""

JUMP_M = 5.0
"""A robot further away than this was reset, or a replay jumped: the camera jumps with it."""

_FIRST_REPORT_SEC = 1.0  # by then a page has reported the camera that it was given
_SAME = 0.002  # of the distance
_STILL_M = 0.0005


class ChaseCamera:
    """
    A camera that follows a robot and keeps the view that a person chose.

    The page reports its camera with a delay. A report that differs from what was sent is taken as
    a person's input; the camera then stands for a moment. Times are of a steady wall clock.

    :param offset: from the robot to the camera.
    """

    def __init__(self, robot: Array, offset: Array, *, now_sec: float) -> None:
        self.at = robot.copy()
        self.offset = offset
        self._begun_sec = self._before_sec = now_sec
        self._paused_until_sec = -math.inf
        self._confirmed = False  # the page has reported the first pose
        self._reported: Array | None = None
        self._sent_sec = -math.inf
        self._is_sent = True  # a pose with this offset
        # Offsets that a person has changed, and until when poses with them may come to the page.
        self._stale: list[tuple[Array, float]] = []
        self._overridden = False

    def report(self, offset: Array) -> None:
        """Take what the page reports of its camera; from any thread."""
        self._reported = offset

    def step(self, robot: Array, *, now_sec: float) -> bool:
        """Advance; returns whether the camera is to be moved, to look at `at` from `offset`."""
        self._read_report(now_sec)
        if now_sec - self._sent_sec < REPORT_TIMEOUT_SEC:
            return False
        elapsed_sec, self._before_sec = now_sec - self._before_sec, now_sec
        if now_sec < self._paused_until_sec:
            return False
        lag = robot - self.at
        distance_m = float(np.linalg.norm(lag))
        if distance_m < _STILL_M:
            moves = self._overridden or not self._confirmed
            self._is_sent, self._overridden = self._is_sent or moves, False
            return moves
        self._overridden = False
        self._is_sent, self._sent_sec = True, now_sec
        gain = 1.0 - math.exp(-elapsed_sec / TIME_CONSTANT_SEC)
        self.at = robot.copy() if distance_m > JUMP_M else self.at + gain * lag
        return True

    def _read_report(self, now_sec: float) -> None:
        offset, self._reported = self._reported, None
        self._confirmed = self._confirmed or now_sec - self._begun_sec > _FIRST_REPORT_SEC
        if offset is None or not np.any(offset):
            return
        on_its_way = self._sent_sec > -math.inf
        self._sent_sec = -math.inf
        if _same(offset, self.offset):
            self._confirmed = True
        elif any(now_sec < until and _same(offset, stale) for stale, until in self._stale):
            # A pose that was still on its way has overridden the person's input.
            self._overridden = True
        elif self._confirmed:  # else the report is older than the first pose
            if self._is_sent:  # not amid a turn of the wheel, which is several reports
                until_sec = now_sec + (DELIVERY_SEC if on_its_way else USER_PAUSE_SEC)
                self._stale = [each for each in self._stale if now_sec < each[1]]
                self._stale.append((self.offset, until_sec))
            self._is_sent, self.offset = False, offset
            self._paused_until_sec = now_sec + USER_PAUSE_SEC


def _same(one: Array, other: Array) -> bool:
    return bool(np.linalg.norm(one - other) <= _SAME * np.linalg.norm(other))


class Cameras:
    """
    The cameras of all tabs.

    :param center: what they look at in the beginning.
    :param extent_m: how far off they are then.
    :param seen_from_above: the least and greatest x and y that Top shows.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        tabs: Tabs,
        *,
        center: Array,
        extent_m: float,
        seen_from_above: Bounds,
    ) -> None:
        self._server = server
        self._tabs = tabs
        low_x, high_x, low_y, high_y = seen_from_above
        self._top_center = np.array([(low_x + high_x) / 2.0, (low_y + high_y) / 2.0, center[2]])
        self._top_half_m = ((high_x - low_x) / 2.0, (high_y - low_y) / 2.0)
        self._following: dict[int, ChaseCamera] = {}  # by client
        server.initial_camera.position = center + extent_m * np.array([-0.85, -0.75, 0.75])
        server.initial_camera.look_at = center
        server.initial_camera.fov = math.radians(50.0)
        tabs.on_camera(self._on_camera)
        tabs.on_gone(lambda tab: self._following.pop(tab, None))

    def _on_camera(self, camera: viser.CameraHandle) -> None:
        following = self._following.get(camera.client.client_id)
        if following is not None:
            following.report(camera.position - camera.look_at)

    def choose(
        self,
        client: viser.ClientHandle,
        preset: str,
        *,
        robot: Array,
        yaw: float,
        now_sec: float,
    ) -> None:
        """Bring the camera of a tab to a preset; robot is the position of the one to follow."""
        self._following.pop(client.client_id, None)
        if preset == FOLLOW:
            behind = np.array([-BACK_M * math.cos(yaw), -BACK_M * math.sin(yaw), UP_M])
            self._look(client, robot + behind, robot)
            self._following[client.client_id] = ChaseCamera(robot, behind, now_sec=now_sec)
        elif preset == TOP:
            self._look_down(client)

    def _look_down(self, client: viser.ClientHandle) -> None:
        """Show everything in what the panel leaves free."""
        camera = client.camera
        width, height = max(camera.image_width, 1), max(camera.image_height, 1)
        hidden = PANEL_PX if width > PHONE_PX else 0
        half_x, half_y = self._top_half_m
        half_m = TOP_MARGIN * max(half_y, half_x * height / max(width - hidden, 1))
        above_m = half_m / math.tan(camera.fov / 2.0)
        at = self._top_center + np.array([hidden * half_m / height, 0.0, 0.0])
        # Not exactly from above: the direction up would be undefined.
        self._look(client, at + np.array([0.0, -0.01 * above_m, above_m]), at)

    def _look(self, client: viser.ClientHandle, position: Array, at: Array) -> None:
        def change() -> None:
            # viser refuses a camera that looks straight up or down.
            with contextlib.suppress(ValueError), client.atomic():
                client.camera.position = position
                client.camera.look_at = at
            client.flush()

        self._tabs.between_reports(change)

    def follow(self, robot: Array, *, now_sec: float) -> None:
        """Move the cameras that follow to where the robot is now; call it every frame."""
        clients = self._server.get_clients() if self._following else {}
        for client_id, camera in list(self._following.items()):
            client = clients.get(client_id)
            if client is not None and camera.step(robot, now_sec=now_sec):
                self._look(client, camera.at + camera.offset, camera.at)


def add_camera_buttons(
    gui: viser.GuiApi,
    later: Callable[[Callable[[], None]], None],
    choose: Callable[[viser.ClientHandle, str], None],
) -> None:
    """Add the presets to a panel; `later` is given the call of `choose` for the tab clicked in."""
    buttons = gui.add_button_group('Camera', PRESETS)

    @buttons.on_click
    @in_order
    def _(event: Any) -> None:
        client, preset = event.client, event.target.value
        if client is not None:
            later(lambda: choose(client, preset))
