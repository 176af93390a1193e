# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Transforms against the places of the same things in the physics."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from husky_course.frames import Array
from husky_sim.messages.transforms import TransformsMessage
from husky_sim.ros import transforms
from husky_sim.simulation import Simulation
import mujoco
import numpy as np
import pytest
from rclpy.qos import DurabilityPolicy
from rclpy.serialization import deserialize_message
from tf2_msgs.msg import TFMessage

from husky_sim.config import SimulationConfig

Drive = Callable[..., None]
STAMP = Time(sec=3, nanosec=20_000_000)


class Recorder:
    """A node that keeps what is published, and how."""

    def __init__(self) -> None:
        self.said: dict[str, list[Any]] = {}
        self.qos: dict[str, Any] = {}

    def create_publisher(self, _: Any, topic: str, qos: Any) -> Any:
        self.said[topic], self.qos[topic] = [], qos
        return SimpleNamespace(publish=self.said[topic].append)


def by_child(message: TFMessage) -> dict[str, TransformStamped]:
    return {each.child_frame_id: each for each in message.transforms}


@pytest.fixture
def simulation(worlds: Path, drive: Drive) -> Simulation:
    driven = Simulation(SimulationConfig(world=str(worlds / 'empty.xml')))
    drive(driven, 0.5, 0.4, seconds=1.0)
    mujoco.mj_forward(driven.model, driven.data)
    return driven


def moving(simulation: Simulation, *, localization: bool = True) -> dict[str, TransformStamped]:
    packed = TransformsMessage(localization=localization)
    packed.pack((STAMP.sec, STAMP.nanosec), simulation.robots[0])
    return by_child(deserialize_message(bytes(packed), TFMessage))


def place(transform: TransformStamped) -> list[float]:
    by = transform.transform.translation
    return [by.x, by.y, by.z]


def turn(transform: TransformStamped) -> Array:
    matrix, by = np.zeros(9), transform.transform.rotation
    mujoco.mju_quat2Mat(matrix, np.array([by.w, by.x, by.y, by.z]))
    return matrix.reshape(3, 3)


def in_base(simulation: Simulation, position: Array, matrix: Array) -> Any:
    """Return where something of the physics is in base_link: place and turn."""
    base = simulation.data.body('husky/base_link')
    into = base.xmat.reshape(3, 3).T
    return into @ (position - base.xpos), into @ matrix.reshape(3, 3)


def test_the_wheels_are_where_the_physics_has_them(
    simulation: Simulation,
) -> None:
    frames = moving(simulation)
    for name in ('front_left', 'front_right', 'rear_left', 'rear_right'):
        wheel = simulation.data.body(f'husky/{name}_wheel_link')
        position, matrix = in_base(simulation, wheel.xpos, wheel.xmat)
        frame = frames[f'{name}_wheel_link']
        assert frame.header.frame_id == 'base_link'
        assert frame.header.stamp == STAMP
        assert place(frame) == pytest.approx(position.tolist(), abs=1e-9)
        assert turn(frame) == pytest.approx(matrix, abs=1e-9)


def test_only_the_filter_publishes_odom_to_base_link(simulation: Simulation) -> None:
    base = moving(simulation)['base_link']
    estimate = simulation.robots[0].filtered
    assert (base.header.frame_id, base.header.stamp) == ('odom', STAMP)
    assert place(base) == [estimate.x, estimate.y, 0.0]
    assert turn(base)[0, 0] == pytest.approx(np.cos(estimate.yaw))
    assert 'base_link' not in moving(simulation, localization=False)


def test_sensors_stand_where_the_physics_has_them(simulation: Simulation) -> None:
    recorder = Recorder()
    transforms.create_transform_topics(recorder, '', localization=True)
    frames = by_child(recorder.said['tf_static'][0])
    assert recorder.qos['tf_static'].durability == DurabilityPolicy.TRANSIENT_LOCAL
    for name in ('imu_link', 'front_laser'):
        site = simulation.data.site(f'husky/{name}')
        position, _ = in_base(simulation, site.xpos, site.xmat)
        assert place(frames[name]) == pytest.approx(position.tolist(), abs=1e-9)
    camera = simulation.data.cam('husky/camera')
    position, matrix = in_base(simulation, camera.xpos, camera.xmat)
    assert place(frames['camera']) == pytest.approx(position.tolist(), abs=1e-9)
    # MuJoCo's cameras look along -z with y up, optical frames along z with y down (REP-103).
    assert turn(frames['camera']) == pytest.approx(matrix @ np.diag([1, -1, -1]), abs=1e-9)
    assert place(frames['base_footprint'])[2] == pytest.approx(-0.13228)


def test_each_of_many_robots_has_a_tree_of_its_own() -> None:
    recorder = Recorder()
    transforms.create_transform_topics(recorder, 'alpha/', localization=True)
    assert set(recorder.said) == {'alpha/tf', 'alpha/tf_static'}


def test_without_tf2_msgs_nothing_is_published(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(transforms, 'TFMessage', None)
    recorder = Recorder()
    assert transforms.create_transform_topics(recorder, '', localization=True) == []
    assert recorder.said == {}
