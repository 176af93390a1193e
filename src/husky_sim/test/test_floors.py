# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Floors: how a robot turns on them, and where they end."""

from collections.abc import Callable
import math
from pathlib import Path

from husky_course.robot import RobotStart
from husky_sim.errors import WorldError
from husky_sim.robot.husky import WHEELS
from husky_sim.simulation import SimulatedRobot, Simulation
import mujoco
import pytest

from husky_sim.config import (
    BodyConfig,
    DriveConfig,
    FLOORS,
    GroundConfig,
    LOAD_Y_M,
    SimulationConfig,
)

Drive = Callable[..., None]

# Effective track on the spot: what is published, where something is. docs/simulator.md has the
# sources.
TRACKS_M = {
    'asphalt': (1.00, 1.10),
    'concrete_indoor': (0.82, 0.95),
    'wet': (0.90, 1.00),
    'gravel': (1.05, 1.15),
    'grass': (1.10, 1.20),
}


def on(world: Path | str, floor: str, *, yaw: float = 0.0, load_y_m: float = 0.0) -> Simulation:
    config = SimulationConfig(
        world=str(world),
        robots=(RobotStart(yaw=yaw),),
        ground=GroundConfig(floor=floor),
        body=BodyConfig(center_of_mass_y_m=load_y_m),
    )
    return Simulation(config, visual=False)


def track_m(simulation: Simulation, drive: Drive, *, seconds: float = 2.0) -> float:
    """Return the track with which the wheels of a robot that turns on the spot tell its turn."""
    robot = simulation.robots[0]
    drive(simulation, 0.0, 0.5, seconds=1.0)
    begin = robot.state.yaw
    drive(simulation, 0.0, 0.5, seconds=seconds)
    turned = math.remainder(robot.state.yaw - begin, math.tau)
    return robot.controller.config.wheel_separation_m * 0.5 * seconds / turned


def place(robot: SimulatedRobot) -> tuple[float, float]:
    return robot.state.position[0], robot.state.position[1]


@pytest.mark.parametrize('world', ['empty.xml', 'playpen.xml'])
@pytest.mark.parametrize('floor', TRACKS_M)
def test_every_floor_has_its_track_whatever_way_the_robot_faces(
    worlds: Path, drive: Drive, floor: str, world: str
) -> None:
    least_m, most_m = TRACKS_M[floor]
    tracks_m = [track_m(on(worlds / world, floor, yaw=yaw), drive) for yaw in (0.0, 0.6, 1.9)]
    assert least_m <= min(tracks_m) <= max(tracks_m) <= most_m
    assert max(tracks_m) - min(tracks_m) < 0.002


@pytest.mark.parametrize('floor', FLOORS)
def test_unequal_loads_carry_it_away_in_turns_and_let_it_rest(
    worlds: Path, drive: Drive, floor: str
) -> None:
    simulation = on(worlds / 'empty.xml', floor, load_y_m=LOAD_Y_M)
    robot = simulation.robots[0]
    drive(simulation, 0.0, 0.0, seconds=1.0)
    loads = robot.husky.wheel_loads_n()
    assert (loads[1] + loads[3]) / sum(loads) == pytest.approx(0.62, abs=0.01)
    start, furthest_m = place(robot), 0.0
    for _ in range(round(3.0 * math.tau / 0.5 / 0.9)):
        drive(simulation, 0.0, 0.5, seconds=1.0)
        furthest_m = max(furthest_m, math.dist(place(robot), start))
    assert 0.1 <= furthest_m <= 0.5
    drive(simulation, 0.0, 0.0, seconds=2.0)
    rest = place(robot)
    drive(simulation, 0.0, 0.0, seconds=20.0)
    assert math.dist(place(robot), rest) < 0.0001


def test_wheel_odometry_drifts_where_the_track_is_another(worlds: Path, drive: Drive) -> None:
    def drift_m(floor: str) -> float:
        simulation = on(worlds / 'empty.xml', floor)
        robot = simulation.robots[0]
        for leg in range(30):
            drive(simulation, 0.8 * abs(math.sin(leg / 7)), math.sin(leg / 5), seconds=1.0)
        return math.dist((robot.odometry.x, robot.odometry.y), place(robot))

    assert drift_m('concrete_indoor') > 2.0 * drift_m('asphalt') > drift_m('ideal')


def test_what_is_slippery_brakes_badly(worlds: Path, drive: Drive) -> None:
    ways_m = []
    for floor in ('asphalt', 'grass'):
        config = SimulationConfig(
            world=str(worlds / 'empty.xml'),
            ground=GroundConfig(floor=floor),
            drive=DriveConfig(acceleration_limit_m_s2=100.0),
        )
        simulation = Simulation(config, visual=False)
        drive(simulation, 1.0, 0.0, seconds=2.0)
        start = place(simulation.robots[0])
        drive(simulation, 0.0, 0.0, seconds=1.0)
        ways_m.append(math.dist(place(simulation.robots[0]), start))
    assert ways_m[0] == pytest.approx(1.0 / (2 * 9.8 * 1.0), rel=0.4)
    assert ways_m[1] == pytest.approx(1.0 / (2 * 9.8 * 0.35), rel=0.2)


RAMP = """
<mujoco><option timestep="0.004" gravity="0 0 -9.8"/><worldbody>
  <geom name="floor" type="plane" size="50 50 1"/>
  <geom name="ramp" type="box" size="4 4 0.1" pos="5 0 0.6" euler="0 -10 30"/>
</worldbody></mujoco>
"""


def test_a_ramp_has_the_floor_too(tmp_path: Path) -> None:
    world = tmp_path / 'ramp.xml'
    world.write_text(RAMP, encoding='utf-8')
    start = RobotStart(x=5.0)
    config = SimulationConfig(
        world=str(world), robots=(start,), ground=GroundConfig(floor='concrete_indoor')
    )
    simulation = Simulation(config, visual=False)
    robot = simulation.robots[0]
    # It begins level, above the ramp, and comes to stand on it.
    for _ in range(100):
        simulation.advance()
    normal = simulation.world.flat_ground[1].axes[2]
    assert simulation.data.body('husky/base_link').xmat[6:] == pytest.approx(
        _up_along(normal), abs=0.3
    )
    seen = set()
    for contact in simulation.data.contact:
        one, other = (simulation.model.geom(geom).name for geom in contact.geom)
        if other.endswith('_tread'):
            seen.add(one)
            axle = simulation.data.geom(other).xmat.reshape(3, 3)[:, 2]
            across, along = contact.friction[:2]
            assert contact.frame[3:6] == pytest.approx(axle, abs=1e-4)
            assert (along, across) == pytest.approx(tuple(FLOORS['concrete_indoor']))
    assert seen == {'flat ground 1'}
    assert abs(robot.state.velocity[0]) < 0.05


def _up_along(normal: tuple[float, ...]) -> list[float]:
    return [0.0, 0.0, normal[2]]


def test_under_a_bridge_it_drives_on_the_ground(tmp_path: Path, drive: Drive) -> None:
    world = tmp_path / 'bridge.xml'
    bridge = '<geom name="floor of a bridge" type="box" size="3 3 0.1" pos="4.5 0 2"/>'
    world.write_text(RAMP.replace('</worldbody>', f'{bridge}</worldbody>'), encoding='utf-8')
    text = world.read_text(encoding='utf-8')
    world.write_text(text.replace('pos="5 0 0.6"', 'pos="30 0 0.6"'), encoding='utf-8')
    simulation = on(world, 'asphalt')
    drive(simulation, 1.0, 0.0, seconds=3.0)
    assert simulation.robots[0].state.position[2] == pytest.approx(0.132, abs=0.005)
    assert simulation.robots[0].state.position[0] > 2.5


def test_two_robots_on_one_floor_do_not_share_their_contacts(worlds: Path, drive: Drive) -> None:
    robots = (RobotStart(name='a'), RobotStart(name='b', x=-4.75, y=9.6, yaw=math.pi / 2))
    config = SimulationConfig(world=str(worlds / 'playpen.xml'), robots=robots)
    simulation = Simulation(config, visual=False)
    # b stands at the edge of the asphalt, where its wheels are cylinders.
    drive(simulation, 0.0, 0.0, seconds=0.1)
    names = [
        {simulation.model.geom(geom).name for geom in contact.geom}
        for contact in simulation.data.contact
    ]
    for wheel in WHEELS:
        assert {f'a/{wheel}_tread', 'flat ground 1'} in names
        assert {f'b/{wheel}_wheel', 'asphalt_plane'} in names


def test_a_robot_without_treads_is_refused(worlds: Path, tmp_path: Path) -> None:
    world = tmp_path / 'world.xml'
    world.write_text((worlds / 'empty.xml').read_text(encoding='utf-8'), encoding='utf-8')
    husky = (worlds / 'husky.xml').read_text(encoding='utf-8')
    old = husky.replace('<geom name="rear_left_tread" class="husky_ground_tread"/>', '')
    assert old != husky
    (tmp_path / 'husky.xml').write_text(old, encoding='utf-8')
    with pytest.raises(WorldError, match=r'no geom named rear_left_tread; take the husky\.xml'):
        on(world, 'asphalt')


def test_where_a_world_sets_all_contacts_they_are_the_worlds(tmp_path: Path, drive: Drive) -> None:
    world = tmp_path / 'override.xml'
    flag = '<option o_margin="0"><flag override="enable"/></option><worldbody>'
    world.write_text(RAMP.replace('<worldbody>', flag, 1), encoding='utf-8')
    simulation = on(world, 'grass')
    assert simulation.world.flat_ground == ()
    drive(simulation, 0.5, 0.0, seconds=1.0)
    assert simulation.robots[0].state.position[0] > 0.3
    assert mujoco.mj_id2name(simulation.model, mujoco.mjtObj.mjOBJ_PAIR, 0) is None


MESH = '<mesh name="m" vertex="0 -1 0 0 1 0 2 -1 0 2 1 0 1 -1 .1 1 1 .1 2 -1 .1 2 1 .1"/>'
HILL = '<hfield name="h" nrow="3" ncol="3" size="2 2 .3 .1" elevation="0 0 0 0 1 0 0 0 0"/>'


@pytest.mark.parametrize(
    ('shape', 'height_m'),
    [
        ('type="mesh" mesh="m" pos="1 0 0"', 0.09),
        ('type="hfield" hfield="h" pos="3 0 0"', 0.1),
        ('type="cylinder" size="1 0.03" pos="2 0 0.03"', 0.06),
        ('type="ellipsoid" size="1 1 0.1" pos="2 0 0"', 0.09),
        ('type="box" size="1 1 0.03" pos="2 0 0.03"', 0.06),
        ('type="box" size="1 1 0.03" pos="2 0 0.03" surfacevel="0.1 0 0"', 0.06),
    ],
)
def test_a_ramp_of_any_shape_on_a_plane_is_driven_up(
    tmp_path: Path, drive: Drive, shape: str, height_m: float
) -> None:
    world = tmp_path / 'world.xml'
    world.write_text(
        f'<mujoco><asset>{MESH}{HILL}</asset><worldbody><geom name="floor" type="plane" '
        f'size="9 9 1"/><geom name="ramp" {shape}/></worldbody></mujoco>'
    )
    simulation = on(world, 'asphalt')
    begin_m = simulation.robots[0].state.position[2]
    drive(simulation, 0.5, 0.0, seconds=4.2)
    assert simulation.robots[0].state.position[2] - begin_m > 0.9 * height_m


@pytest.mark.skipif(not hasattr(mujoco.MjModel, 'geom_surfacevel'), reason='since MuJoCo 4')
def test_a_belt_carries_the_robot(tmp_path: Path, drive: Drive) -> None:
    world = tmp_path / 'world.xml'
    belt = '<geom name="ground" type="box" size="8 8 1" pos="0 0 -1" surfacevel="0.5 0 0"/>'
    world.write_text(f'<mujoco><worldbody>{belt}</worldbody></mujoco>')
    simulation = on(world, 'asphalt')
    drive(simulation, 0.0, 0.0, seconds=2.0)
    assert place(simulation.robots[0]) == pytest.approx((1.0, 0.0), abs=0.05)
