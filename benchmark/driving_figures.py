# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Print how the simulated Husky drives, as the tables of docs/simulator.md.

Run it with:  ./lab exec python benchmark/driving_figures.py
"""

from argparse import ArgumentParser
from collections.abc import Iterable, Iterator
from itertools import repeat
import math
from statistics import mean

from husky_course.robot import RobotStart
from husky_sim.robot.battery import Battery
from husky_sim.simulation import SimulatedRobot, Simulation
from husky_sim.world import default_worlds

from husky_sim.config import (
    BodyConfig,
    CONTROL_PERIOD_SEC,
    FLOORS,
    GroundConfig,
    LOAD_Y_M,
    PowerConfig,
    SimulationConfig,
)

SPEEDS = (0.0, 0.25, 0.5, 0.75, 1.0)
YAW_RATES = (0.2, 0.5, 1.0, 1.5)


def on(
    floor: str, *, x: float = 0.0, load_y_m: float = 0.0, battery: bool = False
) -> tuple[Simulation, SimulatedRobot]:
    """Put one robot on level ground."""
    config = SimulationConfig(
        world=str(default_worlds() / 'empty.xml'),
        robots=(RobotStart(x=x),),
        ground=GroundConfig(floor=floor),
        body=BodyConfig(center_of_mass_y_m=load_y_m),
        power=PowerConfig(battery=battery),
    )
    simulation = Simulation(config)
    return simulation, simulation.robots[0]


def drive(simulation: Simulation, speed: float, yaw_rate: float, seconds: float) -> None:
    """Command the robot for a while."""
    for _ in range(round(seconds / CONTROL_PERIOD_SEC)):
        simulation.robots[0].controller.command(speed, yaw_rate, time_sec=simulation.time_sec)
        simulation.advance()


def plan(robot: SimulatedRobot) -> tuple[float, float]:
    """Return where the robot is."""
    return robot.state.position[0], robot.state.position[1]


def effective_track_m(floor: str, speed: float, yaw_rate: float) -> float:
    """Return the track with which the wheel speeds give the true yaw rate."""
    simulation, robot = on(floor)
    drive(simulation, speed, yaw_rate, 1.0)
    turned, periods = 0.0, 150
    for _ in range(periods):
        before = robot.state.yaw
        drive(simulation, speed, yaw_rate, CONTROL_PERIOD_SEC)
        turned += math.remainder(robot.state.yaw - before, math.tau)
    measured = turned / (periods * CONTROL_PERIOD_SEC)
    return robot.controller.config.wheel_separation_m * yaw_rate / measured


def three_turns_m(floor: str, yaw_rate: float, load_y_m: float) -> float:
    """Return how far three turns on the spot move the centre."""
    simulation, robot = on(floor, load_y_m=load_y_m)
    furthest = 0.0
    for _ in range(math.ceil(3.0 * math.tau / yaw_rate)):
        drive(simulation, 0.0, yaw_rate, 1.0)
        furthest = max(furthest, math.hypot(*plan(robot)))
    return furthest


def least_load(floor: str) -> float:
    """Return the least part of the weight that any wheel bears in turns: a quarter at rest."""
    least = 1.0
    for speed, yaw_rate in ((0.0, 1.0), (0.0, 2.0), (0.5, 1.5)):
        simulation, robot = on(floor)
        drive(simulation, 0.0, 0.0, 1.0)
        weight = sum(robot.husky.wheel_loads_n())
        drive(simulation, speed, yaw_rate, 1.0)
        for _ in range(100):
            drive(simulation, speed, yaw_rate, CONTROL_PERIOD_SEC)
            least = min(least, min(robot.husky.wheel_loads_n()) / weight)
    return least


def stop(floor: str) -> tuple[float, float]:
    """Return the time and the way from 1 m/s to a stop."""
    simulation, robot = on(floor, x=-10.0)
    drive(simulation, 1.0, 0.0, 3.0)
    start, begin_sec = plan(robot), simulation.time_sec
    while robot.state.velocity[0] > 0.01:
        drive(simulation, 0.0, 0.0, CONTROL_PERIOD_SEC)
    taken_sec = simulation.time_sec - begin_sec
    drive(simulation, 0.0, 0.0, 1.0)
    return taken_sec, math.dist(plan(robot), start)


def curves() -> Iterator[tuple[float, float]]:
    """Yield the speeds and turn rates of a minute of curves to both sides."""
    for leg in range(60):
        for _ in range(50):
            yield 0.8 * abs(math.sin(leg / 7)), 0.9 * math.sin(leg / 5)


def drift_m(floor: str) -> tuple[float, float, float]:
    """Return a minute's way, and the errors of wheel and of filtered odometry at its end."""
    simulation, robot = on(floor)
    way, last = 0.0, plan(robot)
    for speed, yaw_rate in curves():
        drive(simulation, speed, yaw_rate, CONTROL_PERIOD_SEC)
        way, last = way + math.dist(plan(robot), last), plan(robot)
    wheels = math.dist((robot.odometry.x, robot.odometry.y), plan(robot))
    fused = math.dist((robot.filtered.x, robot.filtered.y), plan(robot))
    return way, wheels, fused


def power_row(motion: str, floor: str, commands: Iterable[tuple[float, float]]) -> str:
    """Return what a battery gives for a motion, but for its first two seconds."""
    simulation, robot = on(floor, x=-10.0, battery=True)
    given = []
    for speed, yaw_rate in commands:
        drive(simulation, speed, yaw_rate, CONTROL_PERIOD_SEC)
        if robot.battery is not None and simulation.time_sec > 2.0:
            given.append((robot.battery.voltage_v, robot.battery.current_a))
    power_w = mean(volts * amperes for volts, amperes in given)
    volts, amperes = (mean(each) for each in zip(*given, strict=True))
    lasts = f'{hours(power_w):.1f}'
    return f'| {motion} | `{floor}` | {volts:.1f} | {amperes:.1f} | {power_w:.0f} | {lasts} |'


def hours(power_w: float) -> float:
    """Return how long a full battery gives this power."""
    battery, seconds = Battery(1.0), 0
    while not battery.is_empty:
        battery.draw(power_w, 1.0)
        seconds += 1
    return seconds / 3600.0


def most_w() -> float:
    """Return the most that it takes from rest to 1 m/s, and on to -1 m/s."""
    simulation, robot = on('asphalt', battery=True)
    most = 0.0
    for speed in (1.0, -1.0):
        for _ in range(50):
            drive(simulation, speed, 0.0, CONTROL_PERIOD_SEC)
            if robot.battery is not None:
                most = max(most, robot.battery.voltage_v * robot.battery.current_a)
    return most


def print_power() -> None:
    """Print the table of the battery."""
    print('\n| motion | floor | V | A | W | a full battery lasts, h |\n|---|---|---|---|---|---|')
    for motion, speed, floor in (
        ('standing', 0.0, 'asphalt'),
        ('straight on at 0.5 m/s', 0.5, 'asphalt'),
        ('straight on at 1 m/s', 1.0, 'asphalt'),
    ):
        print(power_row(motion, floor, repeat((speed, 0.0), 250)))
    for floor in ('grass', 'concrete_indoor', 'asphalt'):
        print(power_row('turning on the spot at 1 rad/s', floor, repeat((0.0, 1.0), 250)))
    print(power_row('a minute of curves', 'asphalt', curves()))
    print(f'\nFrom rest to 1 m/s, and on to -1 m/s, at 3 m/s2: {most_w():.0f} W at most')


def main() -> None:
    """Print the tables."""
    ArgumentParser(description=__doc__).parse_args()
    print('Effective track on asphalt, m:\n')
    print('| speed m/s | ' + ' | '.join(f'{rate:g} rad/s' for rate in YAW_RATES) + ' |')
    print('|---|' + '---|' * len(YAW_RATES))
    for speed in SPEEDS:
        row = [f'{effective_track_m("asphalt", speed, rate):.3f}' for rate in YAW_RATES]
        print(f'| {speed:g} | ' + ' | '.join(row) + ' |')
    print(
        '\n| floor | friction along, across | track on the spot, m | three turns move it by, m '
        '| least load of a wheel in turns '
        '| stop from 1 m/s | a minute, m | wheel odometry off by, m | filtered off by, m |'
    )
    print('|---|---|---|---|---|---|---|---|---|')
    for floor, grip in FLOORS.items():
        track = effective_track_m(floor, 0.0, 0.5)
        (taken_sec, braked_m), (way, wheels, fused) = stop(floor), drift_m(floor)
        turns = [three_turns_m(floor, 0.5, load) for load in (0.0, LOAD_Y_M)]
        print(
            f'| `{floor}` | {grip.along:g}, {grip.across:g} | {track:.3f} | '
            f'{turns[0]:.3f}; {turns[1]:.2f} with unequal loads | '
            f'{100.0 * least_load(floor):.0f} % | '
            f'{taken_sec:.2f} s, {braked_m:.3f} m | {way:.1f} | {wheels:.2f} | {fused:.2f} |'
        )
    print_power()


if __name__ == '__main__':
    main()
