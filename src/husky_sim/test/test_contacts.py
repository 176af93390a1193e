# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which obstacle is named when a robot touches something, and which is not."""

from collections.abc import Callable
import csv
import math
from pathlib import Path

from husky_sim.contacts import Touch
from husky_sim.simulation import Simulation
import pytest

from husky_sim.config import RobotStart, SimulationConfig

OnAsphalt = Callable[..., Simulation]
WORLDS = Path(__file__).resolve().parents[3] / 'worlds'
TABLE = Path(__file__).with_name('playpen_obstacles.csv')
OBSTACLES = list(csv.DictReader(TABLE.read_text(encoding='utf-8').splitlines()))

BOX = '<body name="box" pos="{x} 0 0.5"><geom type="box" size="0.1 1 0.5"/></body>'


def touches(
    simulation: Simulation, speed_m_s: float, *, seconds: float, yaw_rate_rad_s: float = 0.0
) -> list[Touch]:
    """Drive, and return every touch."""
    found = []
    for _ in range(round(seconds / 0.02)):
        for robot in simulation.robots:
            robot.controller.command(speed_m_s, yaw_rate_rad_s, time_sec=simulation.time_sec)
        simulation.advance()
        found += simulation.touches
    return found + simulation.unreported_touches()


def approach(row: dict[str, str]) -> RobotStart:
    """Stand before an obstacle, on the side of the playpen's middle, and face it."""
    x, y, yaw = (float(row[column]) for column in ('x', 'y', 'yaw'))
    if row['name'].startswith('jersey'):
        away = yaw + math.pi / 2.0  # before its long side
        if math.hypot(x + math.cos(away), y + math.sin(away)) > math.hypot(x, y):
            away += math.pi
    elif 'Barrel' in row['name']:
        # The rows stand close: one is met from the north, the column from the west.
        away = math.atan2(-y, -x) if y < 3.0 else math.pi / 2.0 if y > 6.5 else math.pi
    else:
        away = math.atan2(-y, -x)
    along = 1.2 if row['name'] == 'jersey_barrier_5' else 0.0  # a dumpster stands before it
    return RobotStart(
        x=x + 1.35 * math.cos(away) + along, y=y + 1.35 * math.sin(away), yaw=away + math.pi
    )


@pytest.mark.parametrize('row', OBSTACLES, ids=lambda row: row['name'])
def test_driving_at_an_obstacle_names_it_and_no_other(row: dict[str, str]) -> None:
    world = str(WORLDS / 'playpen.xml')
    simulation = Simulation(SimulationConfig(world=world, robots=(approach(row),)))
    found = touches(simulation, 0.5, seconds=2.5)
    assert {touch.obstacle for touch in found} == {row['name']}
    assert len(found) == 1
    assert found[0].robot == 'husky'
    assert found[0].force_n > 0.0


def test_a_touch_says_when_where_and_with_which_part(on_asphalt: OnAsphalt) -> None:
    simulation = on_asphalt(BOX.format(x=2.0))
    (touch,) = touches(simulation, 0.5, seconds=4.0)
    assert touch.obstacle == 'box'
    assert touch.part == 'front_bumper'
    assert touch.position[0] == pytest.approx(1.9, abs=0.01)
    gap_m = 1.9 - 0.4937
    assert touch.time_sec == pytest.approx(gap_m / 0.5 + 0.5 / 3.0 / 2.0, abs=0.05)
    assert 100.0 < touch.force_n < 20000.0


def test_backing_into_something_names_the_rear_bumper(on_asphalt: OnAsphalt) -> None:
    (touch,) = touches(on_asphalt(BOX.format(x=-2.0)), -0.5, seconds=4.0)
    assert touch.part == 'rear_bumper'


def test_a_lasting_touch_is_one_touch_and_a_second_one_is_another(on_asphalt: OnAsphalt) -> None:
    simulation = on_asphalt(BOX.format(x=1.5))
    assert len(touches(simulation, 0.5, seconds=4.0)) == 1
    assert touches(simulation, -0.5, seconds=2.0) == []
    assert len(touches(simulation, 0.5, seconds=4.0)) == 1


def test_leaving_the_asphalt_and_climbing_back_touches_nothing() -> None:
    # Through the widest gap in the wall, in the north. The edge is 5 cm high.
    world = str(WORLDS / 'playpen.xml')
    start = RobotStart(x=-4.75, y=8.5, yaw=math.pi / 2.0)
    simulation = Simulation(SimulationConfig(world=world, robots=(start,)))
    robot = simulation.robots[0]
    assert touches(simulation, 0.8, seconds=4.0) == []
    assert robot.state.position[2] == pytest.approx(0.13, abs=0.01), 'it should be off the asphalt'
    assert touches(simulation, -0.8, seconds=4.0) == []
    assert robot.state.position[2] == pytest.approx(0.18, abs=0.01), 'it should be on it again'


def test_two_robots_that_meet_name_one_another(worlds: Path) -> None:
    robots = (RobotStart(name='alpha'), RobotStart(name='beta', x=2.0, yaw=math.pi))
    simulation = Simulation(SimulationConfig(world=str(worlds / 'empty.xml'), robots=robots))
    found = touches(simulation, 0.5, seconds=2.5)
    assert {(touch.robot, touch.obstacle) for touch in found} == {
        ('alpha', 'beta'),
        ('beta', 'alpha'),
    }


@pytest.mark.parametrize(
    ('name', 'least_m', 'most_m'),
    [
        ('Construction Cone', 0.5, 3.0),
        ('Dumpster_0', 0.5, 3.0),
        ('Construction Barrel', 0.0, 0.05),
    ],
)
def test_a_pushed_obstacle_moves_as_its_mass_says(
    name: str, least_m: float, most_m: float
) -> None:
    row = next(row for row in OBSTACLES if row['name'] == name)
    world = str(WORLDS / 'playpen.xml')
    simulation = Simulation(SimulationConfig(world=world, robots=(approach(row),)))
    body = simulation.model.body(name).id
    touches(simulation, 0.0, seconds=0.1)
    before = simulation.data.xpos[body].copy()
    touches(simulation, 0.5, seconds=4.0)
    moved_m = math.dist(simulation.data.xpos[body][:2], before[:2])
    assert least_m <= moved_m <= most_m
    assert simulation.physics_warnings == 0
