# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How the simulated A200 drives: the figures a skid-steer robot has to meet."""

from collections.abc import Callable
from itertools import product
import math
from pathlib import Path

from husky_sim.simulation import SimulatedRobot, Simulation
import mujoco
import pytest

from husky_sim.config import CONTROL_PERIOD_SEC, SimulationConfig

OnAsphalt = Callable[..., Simulation]
Drive = Callable[..., None]


def plan(robot: SimulatedRobot) -> tuple[float, float]:
    return robot.state.position[0], robot.state.position[1]


def test_the_robot_turns_as_fast_as_it_is_told_at_every_speed(
    on_asphalt: OnAsphalt, drive: Drive
) -> None:
    simulation = on_asphalt()
    robot = simulation.robots[0]
    for speed, yaw_rate in product((0.0, 0.25, 0.5, 0.75, 1.0), (0.2, -0.6, 1.0, -1.5)):
        simulation.reset()
        drive(simulation, speed, yaw_rate, seconds=1.0)
        turned = 0.0
        for _ in range(50):
            before = robot.state.yaw
            drive(simulation, speed, yaw_rate, seconds=0.04)
            turned += math.remainder(robot.state.yaw - before, math.tau)
        measured = turned / 2.0
        # With this track the wheel speeds give the true yaw rate.
        track_m = robot.controller.config.wheel_separation_m * yaw_rate / measured
        case = f'{speed} m/s, {yaw_rate} rad/s'
        assert measured == pytest.approx(yaw_rate, rel=0.08), case
        assert 1.00 <= track_m <= 1.14, case


def test_three_turns_on_the_spot_leave_the_centre_where_it_was(
    on_asphalt: OnAsphalt, drive: Drive
) -> None:
    simulation = on_asphalt()
    robot = simulation.robots[0]
    furthest = 0.0
    for _ in range(round(3.0 * math.tau / 0.5)):
        drive(simulation, 0.0, 0.5, seconds=1.0)
        furthest = max(furthest, math.hypot(*plan(robot)))
    assert furthest < 0.03


@pytest.mark.parametrize(('speed', 'yaw_rate'), [(0.0, 1.0), (0.0, 2.0), (1.0, -1.5)])
def test_no_wheel_loses_its_share_of_the_weight_in_a_turn(
    on_asphalt: OnAsphalt, drive: Drive, speed: float, yaw_rate: float
) -> None:
    simulation = on_asphalt()
    robot = simulation.robots[0]
    drive(simulation, speed, yaw_rate, seconds=1.0)
    weight_n = 56.582 * 9.8
    for _ in range(50):
        drive(simulation, speed, yaw_rate, seconds=CONTROL_PERIOD_SEC)
        shares = [load / weight_n for load in robot.husky.wheel_loads_n()]
        assert sum(shares) == pytest.approx(1.0, abs=0.02), 'it should not hop'
        # A quarter each; a bend at 1.5 m/s2 moves some of it to the outer wheels.
        assert min(shares) > 0.25 - 0.07, shares


def test_a_shorter_timestep_takes_it_nowhere_else(
    worlds: Path, tmp_path: Path, drive: Drive
) -> None:
    text = (worlds / 'empty.xml').read_text(encoding='utf-8')
    fine = tmp_path / 'fine.xml'
    fine.write_text(text.replace('timestep="0.004"', 'timestep="0.0005"'), encoding='utf-8')
    ends = []
    for world, steps in (worlds / 'empty.xml', 5), (fine, 40):
        simulation = Simulation(SimulationConfig(world=str(world)))
        assert simulation.world.steps_per_period == steps
        drive(simulation, 0.8, 0.5, seconds=2.0)
        drive(simulation, 0.5, -0.8, seconds=4.0)
        drive(simulation, 0.0, 1.5, seconds=1.0)
        drive(simulation, 0.0, 0.0, seconds=1.0)
        ends.append(simulation.robots[0])
    assert math.dist(plan(ends[0]), plan(ends[1])) < 0.003
    turned = math.remainder(ends[0].state.yaw - ends[1].state.yaw, math.tau)
    assert abs(turned) < math.radians(0.2)


def test_the_servos_accelerate_without_oscillation(on_asphalt: OnAsphalt, drive: Drive) -> None:
    simulation = on_asphalt()
    robot = simulation.robots[0]
    timestep_sec = simulation.model.opt.timestep
    drive(simulation, 0.3, 0.0, seconds=0.06)
    robot.controller.command(0.6, 0.0, time_sec=simulation.time_sec)
    robot.act(simulation.time_sec)
    torques = []
    for _ in range(round(CONTROL_PERIOD_SEC / timestep_sec)):
        mujoco.mj_step(simulation.model, simulation.data)
        torques.append(sum(robot.husky.wheels().torques_n_m))
    # What 56.6 kg and four wheels of 0.74 kg m2 need for 3 m/s2.
    needed = 3.0 * (56.6 * 0.1651 + 4 * 0.74 / 0.1651)
    assert all(0.0 < torque < 2.0 * needed for torque in torques), torques
    assert torques[1:] == sorted(torques[1:], reverse=True), torques


def test_ten_metres_straight_on_stay_straight(on_asphalt: OnAsphalt, drive: Drive) -> None:
    simulation = on_asphalt(x=-10.0)
    robot = simulation.robots[0]
    drive(simulation, 1.0, 0.0, seconds=1.0)
    start, begin_sec = plan(robot), simulation.time_sec
    while robot.state.position[0] - start[0] < 10.0:
        drive(simulation, 1.0, 0.0, seconds=CONTROL_PERIOD_SEC)
    speed = math.dist(plan(robot), start) / (simulation.time_sec - begin_sec)
    assert speed == pytest.approx(1.0, rel=0.01)
    assert abs(math.degrees(robot.state.yaw)) < 0.5
    assert abs(robot.state.position[1]) < 0.02


def test_it_stops_from_full_speed_in_a_third_of_a_second(
    on_asphalt: OnAsphalt, drive: Drive
) -> None:
    simulation = on_asphalt()
    robot = simulation.robots[0]
    drive(simulation, 1.0, 0.0, seconds=2.0)
    start, begin_sec = plan(robot), simulation.time_sec
    while robot.state.velocity[0] > 0.01:
        drive(simulation, 0.0, 0.0, seconds=CONTROL_PERIOD_SEC)
    taken_sec = simulation.time_sec - begin_sec
    drive(simulation, 0.0, 0.0, seconds=0.5)
    assert taken_sec == pytest.approx(1.0 / 3.0, rel=0.1)
    assert math.dist(plan(robot), start) == pytest.approx(1.0 / 6.0, rel=0.1)


def test_at_rest_it_stays_for_a_minute(on_asphalt: OnAsphalt, drive: Drive) -> None:
    simulation = on_asphalt()
    robot = simulation.robots[0]
    drive(simulation, 0.0, 0.0, seconds=2.0)
    start = plan(robot)
    drive(simulation, 0.0, 0.0, seconds=60.0)
    assert math.dist(plan(robot), start) < 0.0001


def test_it_starts_without_a_drop(on_asphalt: OnAsphalt, drive: Drive) -> None:
    simulation = on_asphalt()
    robot = simulation.robots[0]
    height = robot.state.position[2]
    drive(simulation, 0.0, 0.0, seconds=1.0)
    assert robot.state.position[2] == pytest.approx(height, abs=0.0005)


RAMP = '<geom name="ramp" type="box" size="4 2 0.1" pos="5 0 {z}" euler="0 -20 0"/>'


def test_it_climbs_a_ramp_of_twenty_degrees_and_holds_on_it(
    on_asphalt: OnAsphalt, drive: Drive
) -> None:
    # The lower end of the ramp's top lies on the asphalt.
    z = 0.05 + 4.0 * math.sin(math.radians(20.0)) - 0.1 * math.cos(math.radians(20.0))
    simulation = on_asphalt(RAMP.format(z=z))
    robot = simulation.robots[0]
    drive(simulation, 0.5, 0.0, seconds=8.0)
    height = robot.state.position[2]
    assert height > 0.9
    drive(simulation, 0.0, 0.0, seconds=1.0)
    start = robot.state.position
    drive(simulation, 0.0, 0.0, seconds=10.0)
    assert math.dist(robot.state.position, start) < 0.005


WALL = '<body name="wall" pos="2 0 0.5"><geom type="box" size="0.1 3 0.5"/></body>'


def test_pushing_a_wall_neither_enters_it_nor_throws_the_robot(
    on_asphalt: OnAsphalt, drive: Drive
) -> None:
    simulation = on_asphalt(WALL)
    robot = simulation.robots[0]
    drive(simulation, 1.0, 0.0, seconds=3.0)
    wall = simulation.model.body('wall').geomadr[0]
    for _ in range(100):
        drive(simulation, 1.0, 0.0, seconds=CONTROL_PERIOD_SEC)
        contacts = simulation.data.contact
        at_wall = (contacts.geom == wall).any(axis=1)
        assert at_wall.any(), 'it should lean on the wall'
        assert contacts.dist[at_wall].min() > -0.005
        assert robot.state.position[0] + 0.4937 < 1.9 + 0.005
        assert abs(robot.state.position[2] - 0.178) < 0.05
    assert min(robot.wheels.speeds_rad_s) > 1.0, 'the wheels should spin'
    assert simulation.physics_warnings == 0


def test_wheel_odometry_drifts_in_turns_but_fused_yaw_does_not(
    on_asphalt: OnAsphalt, drive: Drive
) -> None:
    simulation = on_asphalt()
    robot = simulation.robots[0]
    drive(simulation, 0.3, 0.2, seconds=20.0)
    assert abs(math.remainder(robot.odometry.yaw - robot.state.yaw, math.tau)) > 0.02
    assert robot.filtered.yaw == pytest.approx(robot.state.yaw, abs=0.005)
    assert math.dist((robot.filtered.x, robot.filtered.y), plan(robot)) < 0.05


PLANE = '<geom name="ground" type="plane" size="50 50 1"/>'


@pytest.mark.parametrize(
    ('body', 'yaw_rate'),
    [
        pytest.param(
            '<geom name="ground" type="cylinder" size="8 0.1" pos="0 0 -0.1"/>', 0.3, id='a disc'
        ),
        pytest.param(
            PLANE + '<geom type="cylinder" size="0.6 0.03" pos="1.7 0.5 0.03"/>', 0.0, id='a puck'
        ),
        pytest.param(
            PLANE + '<geom type="box" size="0.6 0.6 0.02" pos="1.7 0 0.02"/>', 0.0, id='a step'
        ),
        pytest.param(
            '<geom name="ground" type="capsule" size="50 8" pos="0 0 -50" euler="90 0 0"/>',
            0.3,
            id='the back of a hill',
        ),
    ],
)
def test_what_a_wheel_rolls_over_does_not_throw_the_robot(
    tmp_path: Path, drive: Drive, body: str, yaw_rate: float
) -> None:
    world = tmp_path / 'world.xml'
    world.write_text(f'<mujoco><worldbody>{body}</worldbody></mujoco>', encoding='utf-8')
    simulation = Simulation(SimulationConfig(world=str(world)), visual=False)
    robot = simulation.robots[0]
    for _ in range(400):
        drive(simulation, 0.5, yaw_rate, seconds=CONTROL_PERIOD_SEC)
        speed = math.hypot(*robot.state.velocity)
        assert speed < 0.9, f'{speed:.2f} m/s of 0.5 after {simulation.time_sec:.2f} s'
        depth_m = -min(simulation.data.contact.dist, default=0.0)
        assert depth_m < 0.012, f'{depth_m:.3f} m deep after {simulation.time_sec:.2f} s'
