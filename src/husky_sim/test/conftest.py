# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Worlds and drives that several test modules use."""

from collections.abc import Callable, Iterator
from pathlib import Path

from husky_course.robot import RobotStart
from husky_runtime.domains import OwnDomain
from husky_sim.simulation import Simulation
import pytest

from husky_sim.config import CONTROL_PERIOD_SEC, SimulationConfig

WORLDS = Path(__file__).resolve().parents[3] / 'worlds'

# Asphalt is a box in the playpen, and a box is another collision than a plane.
ASPHALT = """
<mujoco>
  <option timestep="0.004" gravity="0 0 -9.8"/>
  <worldbody>
    <geom name="asphalt_plane" type="box" size="20 20 0.05" friction="1 0.005 0.0001"/>
    {more}
  </worldbody>
</mujoco>
"""

MakeWorld = Callable[..., str]
Drive = Callable[..., None]


@pytest.fixture
def domain_id(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """Give a test a DDS domain of its own."""
    with OwnDomain() as domain:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain.number))
        monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        yield domain.number


@pytest.fixture
def worlds() -> Path:
    return WORLDS


@pytest.fixture
def make_world(tmp_path: Path) -> MakeWorld:
    """Write a world of asphalt and of the given bodies."""

    def make(more: str = '') -> str:
        path = tmp_path / 'world.xml'
        path.write_text(ASPHALT.format(more=more), encoding='utf-8')
        return str(path)

    return make


@pytest.fixture
def on_asphalt(make_world: MakeWorld) -> Callable[..., Simulation]:
    """Make a simulation of one robot on asphalt."""

    def make(more: str = '', *, x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> Simulation:
        start = RobotStart(x=x, y=y, yaw=yaw)
        return Simulation(SimulationConfig(world=make_world(more), robots=(start,)))

    return make


@pytest.fixture
def drive() -> Drive:
    """Command every robot for some time, in every control period."""

    def command(
        simulation: Simulation, speed_m_s: float, yaw_rate_rad_s: float, *, seconds: float
    ) -> None:
        for _ in range(round(seconds / CONTROL_PERIOD_SEC)):
            for robot in simulation.robots:
                robot.controller.command(speed_m_s, yaw_rate_rad_s, time_sec=simulation.time_sec)
            simulation.advance()

    return command
