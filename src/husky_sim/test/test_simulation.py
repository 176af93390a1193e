# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A run is a function of its files and commands alone, bit for bit."""

import hashlib
import math
from pathlib import Path
import struct
import subprocess
import sys

from husky_course.robot import RobotStart
from husky_sim.simulation import Simulation
import pytest

from husky_sim.config import SensorConfig, SimulationConfig

WORLD = str(Path(__file__).resolve().parents[3] / 'worlds' / 'playpen.xml')


def trajectory(simulation: Simulation, *, seconds: float = 6.0) -> str:
    """Drive in curves, into the barrier, and hash every state on the way."""
    digest = hashlib.sha256()
    for step in range(round(seconds / 0.02)):
        for robot in simulation.robots:
            robot.controller.command(
                0.6, 0.5 * math.sin(step / 30.0), time_sec=simulation.time_sec
            )
        simulation.advance()
        for robot in simulation.robots:
            digest.update(struct.pack('<3d', *robot.state.position))
            digest.update(struct.pack('<3d', *robot.state.angular_velocity))
            digest.update(struct.pack('<4d', *robot.wheels.angles_rad))
            digest.update(struct.pack('<3d', *robot.imu.acceleration))
            digest.update(struct.pack('<2d', robot.filtered.x, robot.odometry.y))
        for touch in simulation.touches:
            digest.update(repr(touch).encode())
    return digest.hexdigest()


def new_simulation(**sensors: object) -> Simulation:
    return Simulation(
        SimulationConfig(world=WORLD, sensors=SensorConfig(**sensors))  # type: ignore[arg-type]
    )


def test_two_simulations_do_the_same() -> None:
    assert trajectory(new_simulation()) == trajectory(new_simulation())


@pytest.mark.parametrize('noise', [False, True])
def test_a_reset_puts_everything_back_bit_for_bit(noise: bool) -> None:
    simulation = new_simulation(noise=noise)
    state = simulation.robots[0].state
    before = simulation.data.qpos.tobytes(), simulation.data.qvel.tobytes()
    first = trajectory(simulation)
    simulation.reset()
    robot = simulation.robots[0]
    assert simulation.time_ns == 0
    assert (simulation.data.qpos.tobytes(), simulation.data.qvel.tobytes()) == before
    assert robot.state == state
    assert (robot.odometry.x, robot.odometry.yaw, robot.filtered.x) == (0.0, 0.0, 0.0)
    assert robot.controller.speed_m_s == 0.0
    assert trajectory(simulation) == first


def test_another_process_does_the_same() -> None:
    script = (
        f'import sys; sys.path[:0] = {sys.path!r}\n'
        f'import importlib.util as u\n'
        f'spec = u.spec_from_file_location("here", {__file__!r})\n'
        'here = u.module_from_spec(spec); spec.loader.exec_module(here)\n'
        'print(here.trajectory(here.new_simulation(), seconds=3.0))\n'
    )
    done = subprocess.run(
        [sys.executable, '-c', script], capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout.strip() == trajectory(new_simulation(), seconds=3.0)


def test_a_push_of_an_obstacle_is_undone_by_a_reset() -> None:
    start = RobotStart(x=-4.6, y=-8.0, yaw=math.pi)
    simulation = Simulation(SimulationConfig(world=WORLD, robots=(start,)))
    cone = simulation.model.body('Construction Cone').id
    simulation.advance()
    before = simulation.data.xpos[cone].tolist()
    for _ in range(150):
        simulation.robots[0].controller.command(0.5, 0.0, time_sec=simulation.time_sec)
        simulation.advance()
    assert math.dist(simulation.data.xpos[cone], before) > 0.3
    simulation.reset()
    simulation.advance()
    assert simulation.data.xpos[cone].tolist() == before


def test_ten_robots_do_what_one_alone_does() -> None:
    world = WORLD.replace('playpen', 'empty')
    starts = [RobotStart(name=f'husky_{number}', y=3.0 * number) for number in range(10)]

    def ends(robots: list[RobotStart]) -> list[tuple[float, float]]:
        simulation = Simulation(SimulationConfig(world=world, robots=tuple(robots)))
        trajectory(simulation, seconds=2.0)
        states = [robot.state.position for robot in simulation.robots]
        return [(x, y - start.y) for (x, y, _), start in zip(states, robots, strict=True)]

    (alone,) = ends(starts[:1])
    for end in ends(starts):
        assert end == pytest.approx(alone, abs=1e-4)


def test_nothing_moves_otherwise_without_what_is_only_seen() -> None:
    config = SimulationConfig(world=WORLD)
    unseen = Simulation(config, visual=False)
    assert trajectory(unseen) == trajectory(Simulation(config))


def test_time_is_exact_whatever_its_length() -> None:
    simulation = new_simulation()
    simulation.periods = 12_345_678
    assert simulation.time_ns == 246_913_560_000_000
    assert simulation.time_sec == 246913.56


def test_a_minute_of_driving_gives_no_physics_warning() -> None:
    simulation = new_simulation()
    robot = simulation.robots[0]
    for _ in range(3000):
        robot.controller.command(0.5, -0.5, time_sec=simulation.time_sec)
        simulation.advance()
    assert simulation.physics_warnings == 0
    assert math.dist(robot.state.position[:2], (0.0, -1.0)) == pytest.approx(1.0, abs=0.2)
