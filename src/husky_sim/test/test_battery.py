# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Motors with a limit of power and their battery: in the physics, and beside the data sheet."""

from collections.abc import Callable
import math
from pathlib import Path

from husky_course.robot import RobotStart
from husky_sim.robot.battery import Battery, CAPACITY_AH, CUT_OFF_V, POWER_W
from husky_sim.robot.motors import FRICTION_N_M, IDLE_W, RESISTANCE_OHM, TORQUE_N_M_A
from husky_sim.sensors.battery_monitor import BatteryReading, EVERY_PERIODS
from husky_sim.simulation import Simulation
import mujoco
import pytest

from husky_sim.config import (
    CONTROL_PERIOD_SEC,
    DriveConfig,
    GroundConfig,
    PowerConfig,
    SimulationConfig,
)

Drive = Callable[..., None]
MakeRun = Callable[..., Simulation]


@pytest.fixture
def with_battery(worlds: Path) -> MakeRun:
    """Make a simulation of one robot on level ground."""

    def make(
        charge: float = 1.0, *, battery: bool = True, floor: str = 'asphalt', **drive: float
    ) -> Simulation:
        config = SimulationConfig(
            world=str(worlds / 'empty.xml'),
            robots=(RobotStart(x=-10.0),),
            ground=GroundConfig(floor=floor),
            drive=DriveConfig(**drive),
            power=PowerConfig(battery=battery, battery_charge=charge),
        )
        return Simulation(config, visual=False)

    return make


def battery_of(simulation: Simulation) -> Battery:
    battery = simulation.robots[0].battery
    assert battery is not None
    return battery


def drawn_w(simulation: Simulation) -> float:
    battery = battery_of(simulation)
    return battery.voltage_v * battery.current_a


def states(simulation: Simulation, drive: Drive) -> list[tuple[float, ...]]:
    """Drive fast bends, which motors limit, and tell where the robot is after each period."""
    seen = []
    robot = simulation.robots[0]
    for step in range(150):
        drive(simulation, 1.0, 1.5 * math.sin(step / 20.0), seconds=CONTROL_PERIOD_SEC)
        seen.append((*robot.state.position, *robot.state.velocity, *robot.wheels.torques_n_m))
    return seen


@pytest.mark.parametrize(('charge', 'part'), [(1.0, 0.75), (0.05, 0.99)])
def test_full_acceleration_stays_below_the_limit_of_power(
    with_battery: MakeRun, drive: Drive, charge: float, part: float
) -> None:
    simulation = with_battery(charge, floor='ideal', acceleration_limit_m_s2=100.0)
    battery, most_w = battery_of(simulation), 0.0
    limit_w = battery.power_limit_w
    assert limit_w <= POWER_W
    for speed in (1.0, -1.0):
        for _ in range(30):
            drive(simulation, speed, 0.0, seconds=CONTROL_PERIOD_SEC)
            most_w = max(most_w, drawn_w(simulation))
            assert battery.voltage_v > CUT_OFF_V - 0.01
    assert part * limit_w < most_w < 1.001 * limit_w


def test_a_weak_battery_climbs_slower(with_battery: MakeRun, drive: Drive) -> None:
    ways_m, speeds_m_s = [], []
    for charge in (1.0, 0.05):
        simulation = with_battery(charge)
        # As on a slope of 25 degrees.
        angle = math.radians(25.0)
        simulation.model.opt.gravity[:] = -9.8 * math.sin(angle), 0.0, -9.8 * math.cos(angle)
        drive(simulation, 1.0, 0.0, seconds=2.0)
        ways_m.append(simulation.robots[0].state.position[0] + 10.0)
        speeds_m_s.append(simulation.robots[0].state.velocity[0])
    assert 1.0 < ways_m[1] < 0.95 * ways_m[0]
    assert 0.5 < speeds_m_s[1] < 0.95 * speeds_m_s[0] < 0.95


def test_a_turn_on_the_spot_draws_several_times_what_a_straight_takes(
    with_battery: MakeRun, drive: Drive
) -> None:
    powers_w = {}
    for name, speed, yaw_rate in (('rest', 0, 0), ('straight', 1, 0), ('turn', 0, 1)):
        simulation = with_battery()
        drive(simulation, speed, yaw_rate, seconds=3.0)
        powers_w[name] = drawn_w(simulation)
    assert powers_w['rest'] == pytest.approx(IDLE_W, rel=0.01)
    motors_w = {name: power - IDLE_W for name, power in powers_w.items()}
    assert motors_w['turn'] > 4.0 * motors_w['straight'] > 4.0 * 40.0


def test_the_voltage_sags_under_load_and_recovers(with_battery: MakeRun, drive: Drive) -> None:
    simulation = with_battery()
    battery = battery_of(simulation)
    drive(simulation, 0.0, 0.0, seconds=1.0)
    at_rest_v = battery.voltage_v
    drive(simulation, 0.0, 1.0, seconds=2.0)
    assert battery.voltage_v < at_rest_v - 0.5
    drive(simulation, 0.0, 0.0, seconds=2.0)
    assert at_rest_v - 0.05 < battery.voltage_v < at_rest_v


def test_the_charge_falls_by_the_work_and_the_losses(
    with_battery: MakeRun, drive: Drive, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation = with_battery()
    battery, (robot,) = battery_of(simulation), simulation.robots
    step_sec, bare_step = simulation.model.opt.timestep, mujoco.mj_step
    work_j = heat_j = given_j = 0.0

    def measured_step(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        nonlocal work_j, heat_j, given_j
        given_j += drawn_w(simulation) * step_sec  # of the step before
        before = robot.husky.wheels().speeds_rad_s
        bare_step(model, data)
        wheels = robot.husky.wheels()
        for torque, old, new in zip(wheels.torques_n_m, before, wheels.speeds_rad_s, strict=True):
            work_j += torque * (old + new) / 2.0 * step_sec
        for torque, speed in zip(wheels.side_torques_n_m, wheels.side_speeds_rad_s, strict=True):
            current_a = (abs(torque) + FRICTION_N_M) / TORQUE_N_M_A
            heat_w = RESISTANCE_OHM * current_a**2 + FRICTION_N_M * abs(speed)
            heat_j += heat_w * step_sec

    monkeypatch.setattr(mujoco, 'mj_step', measured_step)
    drive(simulation, 0.0, 1.0, seconds=4.0)
    given_j += drawn_w(simulation) * step_sec
    assert given_j == pytest.approx(work_j + heat_j + IDLE_W * simulation.time_sec, rel=0.01)
    used_c = (1.0 - battery.charge) * CAPACITY_AH * 3600.0
    assert used_c * battery.voltage_v == pytest.approx(given_j, rel=0.02)


def test_an_empty_battery_stops_it_and_is_told_once(with_battery: MakeRun, drive: Drive) -> None:
    simulation = with_battery(0.0003)
    battery, (robot,) = battery_of(simulation), simulation.robots
    told = 0
    for _ in range(400):
        drive(simulation, 1.0, 0.0, seconds=CONTROL_PERIOD_SEC)
        told += robot.battery_ran_empty
    assert robot.state.position[0] > -9.0, 'it should drive at first'
    assert (battery.charge, battery.current_a, told) == (0.0, 0.0, 1)
    assert robot.state.velocity[0] == pytest.approx(0.0, abs=1e-3)
    assert robot.controller.speed_m_s == 1.0, 'it is still commanded'


def test_a_reset_fills_the_battery_and_repeats_the_run(
    with_battery: MakeRun, drive: Drive
) -> None:
    simulation = with_battery(0.001)
    first, used = states(simulation, drive), battery_of(simulation).charge
    assert used < 0.001
    simulation.reset()
    assert battery_of(simulation).charge == 0.001
    assert states(simulation, drive) == first
    assert battery_of(simulation).charge == used
    assert states(with_battery(0.001), drive) == first


def test_motors_change_nothing_but_what_is_beyond_them(
    with_battery: MakeRun, drive: Drive
) -> None:
    gentle, hard = [], []
    for battery in (False, True):
        simulation = with_battery(
            battery=battery, acceleration_limit_m_s2=1.0, yaw_acceleration_limit_rad_s2=1.0
        )
        drive(simulation, 0.4, 0.3, seconds=2.0)
        gentle.append(simulation.robots[0].state)
        hard.append(states(simulation, drive))
    assert gentle[0] == gentle[1]
    assert hard[0] != hard[1]


def test_the_wheels_of_a_side_turn_alike_when_it_has_no_more(
    with_battery: MakeRun, drive: Drive
) -> None:
    simulation = with_battery(0.05)
    drive(simulation, 1.0, 1.2, seconds=2.0)
    controller, wheels = simulation.robots[0].controller, simulation.robots[0].wheels
    assert wheels.side_speeds_rad_s[1] < 0.7 * controller.wheel_speeds_rad_s()[1]
    front_left, front_right, rear_left, rear_right = wheels.speeds_rad_s
    assert front_left == pytest.approx(rear_left, abs=0.02)
    assert front_right == pytest.approx(rear_right, abs=0.02)


def test_its_charge_is_guessed_from_the_voltage_as_on_the_robot(
    with_battery: MakeRun, drive: Drive
) -> None:
    simulation = with_battery(0.5)
    (robot,) = simulation.robots
    guesses: list[float] = []
    last: BatteryReading | None = None
    for yaw_rate in (0.0, 1.5, 0.0):
        drive(simulation, 0.0, yaw_rate, seconds=30 * EVERY_PERIODS * CONTROL_PERIOD_SEC)
        last = robot.sensors.battery
        assert last is not None
        guesses.append(last.charge)
    assert last is not None
    assert last.voltage_v == battery_of(simulation).voltage_v
    assert guesses[1] < guesses[0] - 0.2, 'it takes a sag for an empty battery'
    assert guesses[2] == pytest.approx(guesses[0], abs=0.02)
    drive(simulation, 0.0, 1.5, seconds=1.0)
    simulation.reset()
    drive(simulation, 0.0, 0.0, seconds=EVERY_PERIODS * CONTROL_PERIOD_SEC)
    assert robot.sensors.battery is not None
    assert robot.sensors.battery.charge == pytest.approx(guesses[0], abs=0.001)
