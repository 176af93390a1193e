# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which obstacle is named when a robot touches something, and which is not."""

from collections.abc import Callable
import csv
import math
from pathlib import Path

from husky_course.robot import ROBOT_LENGTH_M, RobotStart
from husky_sim.robot.contacts import Collision
from husky_sim.simulation import Simulation
import pytest

from husky_sim.config import SimulationConfig

OnAsphalt = Callable[..., Simulation]
WORLDS = Path(__file__).resolve().parents[3] / 'worlds'
TABLE = Path(__file__).with_name('playpen_obstacles.csv')
OBSTACLES = list(csv.DictReader(TABLE.read_text(encoding='utf-8').splitlines()))

BOX = '<body name="box" pos="{x} 0 0.5"><geom type="box" size="0.1 1 0.5"/></body>'


def touches(
    simulation: Simulation, speed_m_s: float, *, seconds: float, yaw_rate_rad_s: float = 0.0
) -> list[Collision]:
    """Drive, and return every touch."""
    found = []
    for _ in range(round(seconds / 0.02)):
        for robot in simulation.robots:
            robot.controller.command(speed_m_s, yaw_rate_rad_s, time_sec=simulation.time_sec)
        simulation.advance()
        found += simulation.touches
    return found + simulation.unreported_touches()


@pytest.fixture(scope='module')
def playpen() -> Simulation:
    """Load the playpen once; `restart` makes it new."""
    return Simulation(SimulationConfig(world=str(WORLDS / 'playpen.xml')))


def restart(simulation: Simulation, start: RobotStart) -> None:
    """Reset everything, with the robot standing elsewhere."""
    joint = simulation.model.joint('husky/base_joint')
    pose = simulation.model.qpos0[int(joint.qposadr[0]) :][:7]
    pose[:2] = start.x, start.y
    pose[3:] = math.cos(start.yaw / 2.0), 0.0, 0.0, math.sin(start.yaw / 2.0)
    simulation.reset()


def approach(row: dict[str, str]) -> RobotStart:
    """Stand some 0.3 m before an obstacle, where nothing else is in the way, and face it."""
    x, y, yaw, length, width = (
        float(row[column]) for column in ('x', 'y', 'yaw', 'length', 'width')
    )
    reach, along = length / 2.0, 0.0
    if row['name'].startswith('jersey'):
        reach, away = width / 2.0, yaw + math.pi / 2.0  # before its long side
        if math.hypot(x + math.cos(away), y + math.sin(away)) > math.hypot(x, y):
            away += math.pi
        along = 1.2 if row['name'] == 'jersey_barrier_5' else 0.0  # a dumpster stands before it
    elif 'Barrel' in row['name']:
        # The rows stand close: one is met from the north, the column from the west.
        away = math.atan2(-y, -x) if y < 3.0 else math.pi / 2.0 if y > 6.5 else math.pi
    else:
        away = math.atan2(-y, -x)
    distance = reach + ROBOT_LENGTH_M / 2.0 + 0.2
    return RobotStart(
        x=x + distance * math.cos(away) + along,
        y=y + distance * math.sin(away),
        yaw=away + math.pi,
    )


def seen_from(row: dict[str, str], place: tuple[float, float, float]) -> tuple[float, float]:
    """Return how far a place is from an obstacle's middle, along its sides."""
    x, y = place[0] - float(row['x']), place[1] - float(row['y'])
    cos, sin = math.cos(float(row['yaw'])), math.sin(float(row['yaw']))
    return abs(cos * x + sin * y), abs(cos * y - sin * x)


@pytest.mark.parametrize('row', OBSTACLES, ids=lambda row: row['name'])
def test_driving_at_an_obstacle_names_it_and_no_other(
    playpen: Simulation, row: dict[str, str]
) -> None:
    restart(playpen, approach(row))
    assert touches(playpen, 0.0, seconds=0.02) == [], 'it should begin apart from everything'
    (touch,) = touches(playpen, 0.5, seconds=1.5)
    assert (touch.robot, touch.obstacle) == ('husky', row['name'])
    assert touch.part in ('front_bumper', 'front_left_wheel', 'front_right_wheel')
    assert touch.force_n > 10.0
    assert 0.3 < touch.time_sec < 1.4
    along_m, across_m = seen_from(row, touch.position)
    assert along_m < float(row['length']) / 2.0 + 0.01, 'the place lies on the obstacle'
    assert across_m < float(row['width']) / 2.0 + 0.01, 'the place lies on the obstacle'
    assert 0.05 < touch.position[2] < 0.5


def test_a_touch_says_when_where_and_with_which_part(on_asphalt: OnAsphalt) -> None:
    simulation = on_asphalt(BOX.format(x=2.0))
    (touch,) = touches(simulation, 0.5, seconds=4.0)
    assert touch.obstacle == 'box'
    assert touch.part == 'front_bumper'
    assert touch.position[0] == pytest.approx(1.9, abs=0.01)
    gap_m = 1.9 - 0.4937
    assert touch.time_sec == pytest.approx(gap_m / 0.5 + 0.5 / 3.0 / 2.0, abs=0.05)
    # It stops within the 0.1 s, so the peak is above the mean force that this takes.
    assert 56.582 * 0.5 / 0.1 < touch.force_n < 20000.0


def test_backing_into_something_names_the_rear_bumper(on_asphalt: OnAsphalt) -> None:
    (touch,) = touches(on_asphalt(BOX.format(x=-2.0)), -0.5, seconds=4.0)
    assert touch.part == 'rear_bumper'


def test_a_lasting_touch_counts_once_and_a_second_one_again(on_asphalt: OnAsphalt) -> None:
    simulation = on_asphalt(BOX.format(x=1.5))
    assert len(touches(simulation, 0.5, seconds=4.0)) == 1
    assert touches(simulation, -0.5, seconds=2.0) == []
    assert len(touches(simulation, 0.5, seconds=4.0)) == 1


def test_leaving_the_asphalt_and_climbing_back_touches_nothing(playpen: Simulation) -> None:
    # Through the widest gap in the wall, in the north. The edge is 5 cm high.
    restart(playpen, RobotStart(x=-4.75, y=8.5, yaw=math.pi / 2.0))
    robot = playpen.robots[0]
    assert touches(playpen, 0.8, seconds=4.0) == []
    assert robot.state.position[2] == pytest.approx(0.13, abs=0.01), 'it should be off the asphalt'
    assert touches(playpen, -0.8, seconds=4.0) == []
    assert robot.state.position[2] == pytest.approx(0.18, abs=0.01), 'it should be on it again'


@pytest.mark.parametrize('height_m', [0.12, 0.5])  # against wheels alone, and the body, too
@pytest.mark.parametrize(('name', 'obstacles'), [('mattress', ['mattress']), ('Floor_mat', [])])
def test_a_soft_body_is_touched_unless_it_is_called_ground(
    on_asphalt: OnAsphalt, name: str, obstacles: list[str], height_m: float
) -> None:
    simulation = on_asphalt(
        f'<flexcomp name="{name}" type="grid" dim="3" count="3 5 2" mass="20" radius="0.02" '
        f'spacing="0.2 0.2 {height_m - 0.04}" pos="1.2 0 {height_m / 2}">'
        '<pin gridrange="0 0 0 2 4 1"/></flexcomp>'
    )
    found = touches(simulation, 0.5, seconds=2.5)
    assert [(touch.robot, touch.obstacle) for touch in found] == [
        ('husky', obstacle) for obstacle in obstacles
    ]
    x, _, z = simulation.robots[0].state.position
    assert x < 0.8 or z > 0.2, 'it should be held, or stand on it'


def test_a_soft_body_that_is_only_seen_holds_no_wheel(on_asphalt: OnAsphalt) -> None:
    simulation = on_asphalt(
        '<flexcomp name="haze" type="grid" dim="3" count="3 5 2" spacing="0.2 0.2 0.1" mass="20" '
        'radius="0.02" pos="1.2 0 0.07"><pin gridrange="0 0 0 2 4 1"/>'
        '<contact contype="0" conaffinity="0"/></flexcomp>'
    )
    assert touches(simulation, 0.5, seconds=2.5) == []
    assert simulation.robots[0].state.position[0] > 1.0
    assert simulation.robots[0].state.position[2] == pytest.approx(0.18, abs=0.01)


def test_a_cloth_on_an_obstacle_is_no_touch_of_the_robot(on_asphalt: OnAsphalt) -> None:
    simulation = on_asphalt(
        BOX.format(x=2)
        + '<flexcomp name="cloth" type="grid" dim="2" count="5 5 1" spacing="0.1 0.1 0.1" '
        'mass="1" radius="0.02" pos="2 0 1.03"/>'
    )
    assert touches(simulation, 0.0, seconds=0.5) == []
    contacts = simulation.data.contact
    assert (contacts.flex >= 0).any(), 'it should lie on the box'


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
    playpen: Simulation, name: str, least_m: float, most_m: float
) -> None:
    row = next(row for row in OBSTACLES if row['name'] == name)
    restart(playpen, approach(row))
    place = playpen.data.body(name).xpos
    touches(playpen, 0.0, seconds=0.1)
    before = place.copy()
    touches(playpen, 0.5, seconds=3.0)
    assert least_m <= math.dist(place[:2], before[:2]) <= most_m
    assert playpen.physics_warnings == 0


def test_a_wall_that_is_a_plane_is_touched_as_any_other(on_asphalt: OnAsphalt) -> None:
    plane = '<geom name="wall" type="plane" size="9 9 1" pos="1.5 0 0" zaxis="-1 0 0"/>'
    found = touches(on_asphalt(plane), 0.5, seconds=4.0)
    assert [(touch.obstacle, touch.part) for touch in found] == [('wall', 'front_bumper')]


def test_a_robot_stands_on_a_slope_beyond_where_it_is_drawn(on_asphalt: OnAsphalt) -> None:
    slope = '<geom name="slope" type="plane" size="0.1 0.1 1" pos="9 0 0" zaxis="1 0 3"/>'
    simulation = on_asphalt(slope)
    assert touches(simulation, 0.0, seconds=1.0) == []
    assert simulation.robots[0].state.position[2] > 2.5, 'it stood below, and was thrown'
    assert math.hypot(*simulation.robots[0].state.velocity) < 0.05
