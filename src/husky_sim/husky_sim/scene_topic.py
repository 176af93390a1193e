# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The topic `~/scene` for viewers: every pose, and the track of the robots since the last message.

It is published 30 times a second of wall time, and only while it has subscriptions, so that a
viewer costs the same whether the simulation runs in real time or fifty times as fast.
"""

from array import array
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
import hashlib
import time
from typing import Any
from uuid import uuid4

from husky_course.frames import Array
import numpy as np
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float64MultiArray, MultiArrayDimension

from husky_sim.simulation import Simulation
from husky_sim.world.world import load_world, World

TOPIC = '~/scene'
RATE_HZ = 30.0
ROW_SEC = 0.004
"""Wall time from one entry of a track to the next; a fast simulation leaves periods out."""

TRACK = ('x', 'y', 'yaw', 'odom_x', 'odom_y', 'odom_yaw', 'speed_m_s')
"""Of every robot, after the time: the true pose, the estimated one, the true speed."""

_KEY = 16

# Best effort: the simulator must not wait for a viewer that hangs.
QOS = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


@dataclass(frozen=True, kw_only=True)
class Scene:
    """
    One message, decoded.

    :param run: a key of this run of a simulator.
    """

    run: str = ''
    paused: bool
    stopped: tuple[bool, ...] = ()  # by the emergency stop, of every robot
    qpos: Array
    time_sec: Array  # of every entry of the track; the last one is now
    track: Array  # shape (entries, robots, len(TRACK))


class SceneTopic:
    """Publishes the scene of a simulation."""

    def __init__(
        self, node: Node, simulation: Simulation, *, is_paused: Callable[[], bool]
    ) -> None:
        self._simulation = simulation
        self._is_paused = is_paused
        self._watched = False
        self._rows = array('d')
        self._next_row_sec = 0.0
        self._last_row = -1
        self._message = Float64MultiArray()
        world = simulation.world
        # A viewer's world has what is only seen, which the simulation may lack.
        whole = load_world(world.path, world.robots, husky=world.husky)
        self._message.layout.dim = [
            MultiArrayDimension(label='paused, stopped', size=1 + len(world.robots)),
            MultiArrayDimension(label=world_key(whole), size=simulation.model.nq),
            MultiArrayDimension(label=uuid4().hex[:_KEY], size=0),
        ]
        self._publisher = node.create_publisher(Float64MultiArray, TOPIC, QOS)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(1.0 / RATE_HZ, self._on_timer, clock=steady)

    def append(self) -> None:
        """Append the poses of the robots to the track; call it after every control period."""
        if self._watched and time.monotonic() >= self._next_row_sec:
            self._append()

    def _append(self) -> None:
        self._next_row_sec = time.monotonic() + ROW_SEC
        self._last_row = self._simulation.periods
        rows = self._rows
        rows.append(self._simulation.time_sec)
        for robot in self._simulation.robots:
            state, filtered = robot.state, robot.filtered
            rows.extend(
                (
                    state.position[0],
                    state.position[1],
                    state.yaw,
                    filtered.x,
                    filtered.y,
                    filtered.yaw,
                    state.velocity[0],
                )
            )

    def _on_timer(self) -> None:
        self._watched = self._publisher.get_subscription_count() > 0
        if not self._watched:
            return
        if not self._rows or self._last_row != self._simulation.periods:
            self._append()
        stopped = (robot.is_stopped for robot in self._simulation.robots)
        data = array('d', [self._is_paused(), *stopped])
        data.frombytes(self._simulation.data.qpos.tobytes())
        data.extend(self._rows)
        dimensions: Any = self._message.layout.dim
        dimensions[2].size = len(self._rows)
        self._message.data = data
        self._publisher.publish(self._message)
        self._rows = array('d')


def world_key(world: World) -> str:
    """Return a key of a world with its robots; the path of its file does not matter."""
    model = world.model
    parts = (
        *(model.qpos0, model.body_pos, model.body_quat),
        *(model.geom_type, model.geom_size, model.geom_pos, model.geom_quat),
    )
    digest = hashlib.sha256(model.names)
    for part in parts:
        digest.update(np.ascontiguousarray(part).tobytes())
    return digest.hexdigest()[:_KEY]


def origin_of(message: Float64MultiArray) -> tuple[str, str]:
    """Return the key of a message's world and its run; both are empty if it is no scene."""
    labels = [dimension.label for dimension in message.layout.dim]
    return (labels[1], labels[2]) if len(labels) == 3 else ('', '')


def joined(scenes: Sequence[Scene]) -> Scene:
    """Return the newest of some scenes of one run, in order, with the tracks of all."""
    time_sec, track = (
        np.concatenate([getattr(scene, name) for scene in scenes])
        for name in ('time_sec', 'track')
    )
    return replace(scenes[-1], time_sec=time_sec, track=track)


def read_scene(message: Float64MultiArray, *, robots: int) -> Scene:
    """
    Decode a message of a world with so many robots.

    :raises ValueError: if it is of another simulation than one with so many robots.
    """
    data = np.frombuffer(message.data)
    sizes = [dimension.size for dimension in message.layout.dim]
    width = 1 + len(TRACK) * robots
    fits = len(sizes) == 3 and sizes[0] == 1 + robots and sum(sizes) == len(data)
    if not fits or sizes[2] % width or not sizes[2]:
        raise ValueError(f'dimensions {sizes}: no scene of {robots} robots')
    held, qpos, rows = np.split(data, np.cumsum(sizes)[:2])
    rows = rows.reshape(-1, width)
    track = rows[:, 1:].reshape(-1, robots, len(TRACK))
    return Scene(
        run=origin_of(message)[1],
        paused=bool(held[0]),
        stopped=tuple((held[1:] != 0.0).tolist()),
        qpos=qpos,
        time_sec=rows[:, 0],
        track=track,
    )
