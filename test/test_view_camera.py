# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The camera presets in a real browser, which tells where its camera really is."""

from collections.abc import Callable, Iterator
import math
import time

from husky_view.picture.camera import BACK_M, Cameras, PANEL_PX, UP_M
from husky_view.picture.page import FOLLOW, FREE, TOP
from husky_view.server import close_server, PageServer
import numpy as np
import numpy.typing as npt
from playpen_testing.browser import drag, open_page
from playpen_testing.page_client import CAMERA, PageClient
from playpen_testing.waiting import wait_until
from playwright.sync_api import Browser, Page
import pytest
import viser

Array = npt.NDArray[np.float64]

SPEED_M_S, AHEAD = 1.0, np.array([1.0, 0.0, 0.0])
BEHIND = np.array([-BACK_M, 0.0, UP_M])
BEHIND_M = math.hypot(BACK_M, UP_M)
CENTER, EXTENT_M = np.array([0.0, 0.0, 0.5]), 12.0
SEEN = (-9.0, 7.0, -8.0, 8.0)


class Scene:
    """A robot that drives along x on an empty page, and what its one tab tells of its camera."""

    def __init__(self, server: viser.ViserServer, cameras: Cameras, page: Page) -> None:
        self.page = page
        self.robot: Array = np.zeros(3)
        self.driving = False
        self._cameras = cameras
        self.client = next(iter(server.get_clients().values()))
        self._told = (np.zeros(3), np.zeros(3))
        self._before_sec = time.monotonic()
        self._turn_again_sec = 0.0

        @self.client.camera.on_update
        async def _(camera: viser.CameraHandle) -> None:
            self._told = (np.array(camera.position), np.array(camera.look_at))

    @property
    def away_m(self) -> float:
        return float(np.linalg.norm(self.offset))

    @property
    def at(self) -> Array:
        return self._told[1]

    @property
    def offset(self) -> Array:
        return self._told[0] - self._told[1]

    def choose(self, preset: str) -> None:
        self._cameras.choose(
            self.client, preset, robot=self.robot, yaw=0.0, now_sec=time.monotonic()
        )

    def is_zoomed(self) -> bool:
        """Turn the wheel as a person does, who sees whether the page has taken it."""
        if self.away_m > 1.02 * BEHIND_M:
            return True
        if time.monotonic() > self._turn_again_sec:
            self.page.mouse.move(500, 350)
            self.page.mouse.wheel(0, 240)
            self._turn_again_sec = time.monotonic() + 0.5
        return False

    def wait(self, fact: Callable[[], bool], what: str) -> None:
        """Go on as the view's frames do, until the fact holds."""

        def frame() -> bool:
            now = time.monotonic()
            if self.driving:
                self.robot = self.robot + SPEED_M_S * (now - self._before_sec) * AHEAD
            self._before_sec = now
            self._cameras.follow(self.robot, now_sec=now)
            return fact()

        wait_until(frame, timeout_sec=20.0, what=lambda: f'{what}: {self._told}, {self.robot}')


def serve(port: int) -> tuple[PageServer, Cameras]:
    server = PageServer('127.0.0.1', port, title='cameras')
    return server, Cameras(
        server, server.tabs, center=CENTER, extent_m=EXTENT_M, seen_from_above=SEEN
    )


@pytest.fixture(scope='module')
def scene(browser: Browser) -> Iterator[Scene]:
    server, cameras = serve(18780)
    server.gui.add_html('<b class="husky-page" data-number="time">0</b>')
    page = open_page(browser, server.address)
    wait_until(lambda: bool(server.get_clients()), timeout_sec=20.0, what='a tab')
    yield Scene(server, cameras, page)
    page.close()
    close_server(server)


def distance(ones: Array, others: Array) -> float:
    return float(np.linalg.norm(ones - others))


@pytest.mark.timeout(60)
def test_a_camera_follows_as_far_off_as_a_person_sets_it(scene: Scene) -> None:
    scene.choose(FOLLOW)
    scene.driving = True
    scene.wait(lambda: scene.at[0] > 1.0, 'a camera that goes along')
    assert distance(scene.offset, BEHIND) < 0.02
    scene.wait(scene.is_zoomed, 'a camera further away')
    begun = scene.robot[0]
    scene.wait(
        lambda: scene.at[0] > begun + 1.5 and distance(scene.at, scene.robot) < 0.6,
        'a camera that comes after',
    )
    assert scene.away_m > 1.02 * BEHIND_M, 'it went back to its own distance'
    zoomed_m = scene.away_m
    drag(scene.page, (500, 350), (700, 350))
    scene.wait(
        lambda: abs(scene.offset[1]) > 0.5 and distance(scene.at, scene.robot) < 0.6,
        'a camera that follows, seen from the side',
    )
    assert scene.away_m == pytest.approx(zoomed_m, rel=0.05)


@pytest.mark.timeout(60)
def test_free_leaves_the_camera_alone_and_top_looks_down(scene: Scene) -> None:
    scene.choose(FOLLOW)
    scene.driving = False
    scene.wait(lambda: distance(scene.at, scene.robot) < 0.002, 'a camera at the robot')
    scene.choose(FREE)
    stood, begun = scene.at, scene.robot[0]
    scene.driving = True
    scene.wait(lambda: scene.robot[0] > begun + 1.0, 'a robot that drives off')
    assert distance(scene.at, stood) < 0.005, 'a free camera is left alone'
    scene.choose(TOP)
    scene.wait(
        lambda: abs(scene.at[1] - CENTER[1]) < 0.01 and scene.away_m > 12.0,
        'a camera that looks at the middle',
    )
    down = -scene.offset / scene.away_m
    assert down[2] < -0.99
    low_x, high_x, low_y, high_y = SEEN
    seen_m = 2.0 * scene.offset[2] * math.tan(math.radians(25.0))
    assert seen_m > high_y - low_y, 'all of it is in the picture'
    to_the_left_px = (scene.at[0] - (low_x + high_x) / 2.0) / seen_m * 700
    half_px = (high_x - low_x) / 2.0 / seen_m * 700
    assert 500 - to_the_left_px - half_px > 0, 'all of it is in the picture'
    assert 500 - to_the_left_px + half_px < 1000 - PANEL_PX, 'the panel hides a part of it'


@pytest.mark.timeout(60)
def test_a_tab_that_tells_of_its_camera_is_turned_nowhere_else() -> None:
    robot, end = np.array([4.0, 0.0, 0.0]), np.array([-4.0, 0.0, 0.0])
    server, cameras = serve(18790)
    with PageClient(server.address) as tab:
        wait_until(lambda: bool(server.get_clients()), timeout_sec=20.0, what='a tab')
        (client,) = server.get_clients().values()
        for number in range(500):  # one in fifteen was turned elsewhere
            position = [4.0 + number % 3, 2.0, 3.0]
            tab.send({**CAMERA, 'position': position, 'look_at': robot.tolist()})
            cameras.choose(client, FOLLOW, robot=robot, yaw=0.1 * number, now_sec=0.0)
        cameras.choose(client, FOLLOW, robot=end, yaw=0.0, now_sec=0.0)
        while tab.looked_at[-1:] != [end.tolist()]:
            tab.read()
    close_server(server)
    asked = [CENTER.tolist(), robot.tolist(), end.tolist()]
    assert [place for place in tab.looked_at if place not in asked] == []
