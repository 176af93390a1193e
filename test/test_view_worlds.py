# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A page that shows one world after the other."""

import gc
import inspect
from pathlib import Path
from typing import Any
import weakref

from husky_course.robot import RobotStart
from husky_sim.world import default_worlds, load_world, World
from husky_view.live.node import ViewNode
from husky_view.live.panel import Panel
from husky_view.live.simulator import SimulatorQuery
from husky_view.live.view import LiveView
from husky_view.picture.camera import Cameras
from husky_view.picture.coordinates import TopGrids
from husky_view.picture.page import STOP
from husky_view.picture.picture import Picture
from husky_view.server import close_server, PageServer
from playpen_testing.page_client import PageClient
from playpen_testing.waiting import wait_until
import pytest
import rclpy
from rclpy.task import Future

SHOWN = (LiveView, Panel, Picture, Cameras, TopGrids)


def callbacks(server: PageServer) -> list[int]:
    """Count what viser calls when a tab comes, goes, or moves its camera."""
    (client,) = server.get_clients().values()
    kept = (
        server._client_connect_cb,
        server._client_disconnect_cb,
        client.camera._state.camera_cb,
    )
    return [len(each) for each in kept]


def heard_in_a_pool(server: PageServer) -> list[str]:
    """Return what is clicked where a second click may overtake the first one."""
    controls = server.gui._gui_input_handle_from_uuid.values()
    return [
        each.label
        for each in controls
        if not all(map(inspect.iscoroutinefunction, each._impl.update_cb))
    ]


def shown() -> list[object]:
    return [each for each in gc.get_objects() if isinstance(each, SHOWN)]


@pytest.mark.timeout(60)
def test_nothing_stays_of_the_worlds_that_were_shown(domain_id: int, tmp_path: Path) -> None:
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain_id)
    node = rclpy.create_node('view', context=context)
    server = PageServer('127.0.0.1', 18880, title='worlds')
    query = SimulatorQuery(node, 'husky_sim')
    world = load_world(str(default_worlds() / 'empty.xml'), [RobotStart()])
    others = [id(each) for each in shown()]  # pytest keeps what a test that failed has used
    with PageClient(server.address):
        wait_until(lambda: len(server.get_clients()) == 1, timeout_sec=20.0, what='a tab')
        before = callbacks(server)
        for _ in range(3):
            view = LiveView(node, server, query, world, tmp_path, is_stopped=False)
            assert heard_in_a_pool(server) == []
            view.close()
            server.clear()
            assert callbacks(server) == before
    del view
    gc.collect()
    left = [type(each).__name__ for each in shown() if id(each) not in others]
    close_server(server)
    node.destroy_node()
    context.shutdown()
    assert left == []


@pytest.mark.timeout(60)
def test_a_stop_that_is_clicked_while_another_world_is_loaded_holds_it(
    domain_id: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    views: list[LiveView] = []

    class SeenView(LiveView):
        def __init__(self, *args: Any, **options: Any) -> None:
            super().__init__(*args, **options)
            views.append(self)

    rclpy.init(args=['--ros-args', '-p', 'viewer_port:=18990'], domain_id=domain_id)
    node = ViewNode()
    world = load_world(str(default_worlds() / 'empty.xml'), [RobotStart()])

    def load(*_: object) -> World | None:
        if len(views) > 1:
            return None
        controls = node._server.gui._gui_input_handle_from_uuid.values()
        (stop,) = [each for each in controls if each.label == STOP]
        before = stop.update_timestamp
        with PageClient(node._server.address) as tab:
            tab.set(STOP, True)
            wait_until(lambda: stop.update_timestamp > before, timeout_sec=10.0, what='a click')
        return world

    monkeypatch.setattr('husky_view.live.node.LiveView', SeenView)
    monkeypatch.setattr(node, '_wait_for_world', lambda _: world)
    monkeypatch.setattr(node, '_result_of', load)
    try:
        node.show_all(Future())
    finally:
        node.destroy_node()
        rclpy.shutdown()
    assert [each.is_stopped for each in views] == [True, True]


def test_a_world_that_was_waited_for_is_not_kept(domain_id: int) -> None:
    rclpy.init(args=['--ros-args', '-p', 'viewer_port:=18980'], domain_id=domain_id)
    node = ViewNode()
    interrupted: Future[None] = Future()
    loaded: Future[World] = Future()
    loaded.set_result(load_world(str(default_worlds() / 'empty.xml'), [RobotStart()]))
    kept = weakref.ref(node._result_of(loaded, interrupted))
    del loaded
    gc.collect()
    node.destroy_node()
    rclpy.shutdown()
    assert kept() is None, 'the interrupt that may come holds it'
