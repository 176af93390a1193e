# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The live view while no page is open."""

from array import array
from collections.abc import Iterator
from pathlib import Path

from husky_course.robot import RobotStart
from husky_runtime.domains import OwnDomain
from husky_sim.scene_topic import TRACK, world_key
from husky_sim.world import default_worlds, load_world, World
from husky_view.live.simulator import SimulatorQuery
from husky_view.live.view import LiveView
from husky_view.server import close_server, PageServer
from playpen_testing.page_client import PageClient
from playpen_testing.waiting import wait_until
import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray, MultiArrayDimension

SCENES = 100  # more than three seconds of them
STEP_M, STEP_SEC = 0.01, 1.0 / 30.0


@pytest.fixture
def node() -> Iterator[Node]:
    context = Context()
    with OwnDomain() as domain:
        rclpy.init(context=context, domain_id=domain.number)
        made = Node('view', context=context)
        yield made
        made.destroy_node()
        rclpy.shutdown(context=context)


@pytest.fixture
def server() -> Iterator[PageServer]:
    opened = PageServer('127.0.0.1', 18580, title='unwatched')
    yield opened
    close_server(opened)


def scene_of(world: World, number: int) -> Float64MultiArray:
    """Return a message with the first robot a step further than in the one before."""
    message = Float64MultiArray()
    row = [number * STEP_SEC]
    qpos = world.model.qpos0.copy()
    for place, robot in enumerate(world.robots):
        x_m = robot.x + number * STEP_M * (place == 0)
        qpos[world.model.joint(f'{robot.name}/base_joint').qposadr[0]] = x_m
        track = {'x': x_m, 'odom_x': x_m - robot.x, 'y': robot.y}
        row += [track.get(name, 0.0) for name in TRACK]
    message.layout.dim = [
        MultiArrayDimension(label='paused, stopped', size=1 + len(world.robots)),
        MultiArrayDimension(label=world_key(world), size=world.model.nq),
        MultiArrayDimension(label='run', size=len(row)),
    ]
    message.data = array('d', [0.0] * (1 + len(world.robots)) + qpos.tolist() + row)
    return message


def test_nothing_is_sent_to_nobody_and_a_page_shows_what_is_now(
    node: Node, server: PageServer, tmp_path: Path
) -> None:
    robots = (RobotStart(name='alpha'), RobotStart(name='beta', y=3.0))
    world = load_world(str(default_worlds() / 'empty.xml'), robots)
    query = SimulatorQuery(node, 'husky_sim')
    view = LiveView(node, server, query, world, tmp_path, is_stopped=False)
    sent = server._websock_server.get_message_buffer()
    view._on_frame()
    before = sent.message_counter
    for number in range(SCENES):
        view._on_scene(scene_of(world, number))
        view._on_frame()
    assert sent.message_counter == before, 'it was drawn for nobody'
    with PageClient(server.address) as tab:
        wait_until(lambda: server.is_watched, what='a tab')
        view._on_frame()
        end_m = (SCENES - 1) * STEP_M
        while tab.places.get('/alpha/name', [0.0])[0] != pytest.approx(end_m):
            tab.read()
        trail = server.scene.get_handle_by_name('/alpha/true_trail/1')
        assert trail is not None, 'where it has been'
        assert trail.points.max() == pytest.approx(end_m, abs=0.1)
    view.close()
