# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Leaving far obstacles out of the search for contacts changes nothing, to the last bit."""

from collections.abc import Iterator
from pathlib import Path
import random

from husky_course.record import Collision
from husky_course.robot import RobotStart
from husky_sim.robot.broadphase import BroadPhase
from husky_sim.simulation import Simulation
import pytest

from husky_sim.config import SimulationConfig

PERIODS = 600
ALONE = (RobotStart(x=-4.6, y=-8.0, yaw=3.14),)  # before a cone
BESIDE = (RobotStart(x=5.4, y=-1.5, yaw=1.5),)  # between barriers that stand askew and a barrel
CROWD = (
    RobotStart(name='a'),
    RobotStart(name='b', x=-1.2, y=0.9, yaw=-0.6),
    RobotStart(name='c', x=-4.6, y=-8.0, yaw=3.14),
)

State = tuple[bytes, list[Collision]]


def driven(worlds: Path, starts: tuple[RobotStart, ...], seed: int) -> Iterator[State]:
    """Drive about at random; yield what there is after every control period."""
    simulation = Simulation(SimulationConfig(world=str(worlds / 'playpen.xml'), robots=starts))
    chance = random.Random(seed)
    for period in range(PERIODS):
        for robot in simulation.robots:
            if period % 50 == 0:
                speed, yaw_rate = chance.uniform(0.2, 1.0), chance.uniform(-1.0, 1.0)
            robot.controller.command(speed, yaw_rate, time_sec=simulation.time_sec)
        if period == PERIODS // 2:  # thrown, faster than any motor drives
            simulation.data.qvel[-10:-8] = 9.0, 4.0
        simulation.advance()
        yield simulation.data.qpos.tobytes(), simulation.touches


@pytest.mark.parametrize('starts', [ALONE, BESIDE, CROWD], ids=['alone', 'beside', 'crowd'])
def test_a_drive_is_that_with_every_obstacle_looked_at(
    worlds: Path, starts: tuple[RobotStart, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    quick = list(driven(worlds, starts, seed=4))
    monkeypatch.setattr(BroadPhase, 'update', lambda _: None)
    whole = list(driven(worlds, starts, seed=4))
    assert sum(len(touches) for _, touches in whole), 'nothing was touched'
    differing = [period for period in range(PERIODS) if quick[period] != whole[period]]
    assert not differing, f'they part in control period {differing[0]}'


def test_what_touches_sleeps_together_after_a_reset_too(worlds: Path) -> None:
    simulation = Simulation(SimulationConfig(world=str(worlds / 'playpen.xml')))
    at_start = simulation.data.tree_asleep.tolist()
    for _ in range(3):  # then most of the playpen is left out
        simulation.advance()
    simulation.reset()
    assert simulation.data.tree_asleep.tolist() == at_start


@pytest.mark.parametrize(
    ('start', 'names', 'alone'),
    [
        (RobotStart(), set(), True),
        (BESIDE[0], {'Construction Barrel'}, True),  # not before it has gone a quarter metre
        (RobotStart(x=1.0, y=-0.2), {'jersey_barrier_15'}, False),
    ],
    ids=['far', 'beside', 'before'],
)
def test_only_what_can_be_reached_is_looked_at(
    worlds: Path, start: RobotStart, names: set[str], alone: bool
) -> None:
    config = SimulationConfig(world=str(worlds / 'playpen.xml'), robots=(start,))
    simulation = Simulation(config)

    def looked_at() -> set[str]:
        simulation.advance()
        model = simulation.model
        return {model.body(body).name for body in range(model.nbody) if model.body_contype[body]}

    everything = looked_at()
    assert len(everything) == 40
    near = looked_at() - {'world'}
    assert {name for name in near if not name.startswith('husky/')} == names
    assert simulation.broadphase.alone is alone
    simulation.data.qvel[-10] = 9.0
    simulation.advance()
    assert looked_at() == everything, 'too fast to be sure of anything'
