# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Measure one row of simulation_speed.py, and print it as JSON.

The robots drive in circles. A driver in a process of its own reads every topic, so that everything
is published; in lockstep it answers every odometry message.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import gc
import json
import multiprocessing
from pathlib import Path
import signal
import sys
import time
from typing import Any

from geometry_msgs.msg import Twist
from husky_course.robot import RobotStart
from husky_sim.robot.tyres import Tyres
from husky_sim.ros import node as husky_sim_node
from husky_sim.ros.node import SimulatorNode
from husky_sim.world import default_worlds, load_world
import mujoco
from nav_msgs.msg import Odometry
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import Imu, JointState, LaserScan, NavSatFix

from husky_sim.config import FLOORS

SPEED_M_S, YAW_RATE_RAD_S = 0.5, -0.5
CONTROL = 'husky_velocity_controller/cmd_vel'

# Places with room for a circle of 1 m radius to the right of the robot.
STARTS = (
    (0.0, 0.0),
    (-3.0, 1.5),
    (-6.5, 0.5),
    (5.5, 4.0),
    (5.0, -6.0),
    (-1.0, -6.5),
    (-8.0, -7.0),
    (-0.5, 6.5),
    (3.0, 7.3),
    (-4.5, -2.5),
)


READ = {
    'odometry/filtered': Odometry,
    'husky_velocity_controller/odom': Odometry,
    'husky_velocity_controller/cmd_vel_out': Twist,
    'ground_truth/odom': Odometry,
    'imu/data': Imu,
    'joint_states': JointState,
    'navsat/fix': NavSatFix,
    'front/scan': LaserScan,
}


class Ending:
    """Notes SIGTERM; an exception would come up within a callback, and rclpy print it."""

    def __init__(self) -> None:
        self.asked = False
        signal.signal(signal.SIGTERM, self._on_signal)

    def _on_signal(self, *_: object) -> None:
        self.asked = True


def _ignore(_: bytes) -> None:
    pass


def robots_named(count: int) -> list[RobotStart]:
    """Return robots at the first places."""
    return [RobotStart(name=f'r{i}', x=x, y=y) for i, (x, y) in enumerate(STARTS[:count])]


def bare(count: int, seconds: float) -> float:
    """Step the model and nothing else."""
    world = load_world(str(default_worlds() / 'playpen.xml'), robots_named(count))
    model, data = world.model, mujoco.MjData(world.model)
    Tyres(world, data, FLOORS['asphalt'])  # the contacts of the simulator
    track_m, radius_m = 0.5708 * 1.875, 0.1651
    left = (SPEED_M_S - YAW_RATE_RAD_S * track_m / 2.0) / radius_m
    right = (SPEED_M_S + YAW_RATE_RAD_S * track_m / 2.0) / radius_m
    data.ctrl[:] = [left, right] * (model.nu // 2)
    mujoco.mj_step(model, data, nstep=100)
    begin, begin_sec = time.perf_counter(), data.time
    while time.perf_counter() - begin < seconds:
        mujoco.mj_step(model, data, nstep=100)
    return float((data.time - begin_sec) / (time.perf_counter() - begin))


def drive(prefixes: Sequence[str], lockstep: bool, reads: bool) -> None:
    """Command the robots until terminated: after every odometry message, or every 10 ms."""
    # rclpy's own handler would take the context away from under a message on its way.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    ending, simulator = Ending(), multiprocessing.parent_process()
    node = rclpy.create_node('benchmark_driver')
    command = Twist()
    command.linear.x, command.angular.z = SPEED_M_S, YAW_RATE_RAD_S
    publishers = [node.create_publisher(Twist, prefix + CONTROL, 10) for prefix in prefixes]

    def answer(*_: object) -> None:
        for publisher in publishers:
            publisher.publish(command)

    if reads:
        for topic, kind in READ.items():
            for prefix in prefixes:
                node.create_subscription(kind, prefix + topic, _ignore, 10, raw=True)
    if lockstep:
        node.create_subscription(Odometry, f'{prefixes[-1]}odometry/filtered', answer, 10)
    else:
        node.create_timer(0.01, answer)

    def look() -> None:
        ending.asked = ending.asked or simulator is None or not simulator.is_alive()

    node.create_timer(0.5, look)
    executor = EventsExecutor()
    executor.add_node(node)
    while not ending.asked:
        executor.spin_once(timeout_sec=0.1)
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()


def node_speed(given: argparse.Namespace, ending: Ending) -> tuple[float, float]:
    """Run the simulator's node; return simulated seconds a second, and a second of its CPU."""
    parameters, prefixes = given.parameters, ['']
    if given.robots > 1:
        robots = robots_named(given.robots)
        parameters['robots'] = [f'{r.name} {r.x} {r.y} {r.yaw}' for r in robots]
        prefixes = [f'{robot.name}/' for robot in robots]
    parameters = {'real_time_factor': 0.0, 'command_timeout_sec': 60.0, **parameters}
    overrides = [Parameter(name, value=value) for name, value in parameters.items()]
    rclpy.init(
        args=['--ros-args', '--log-level', 'warn'],
        signal_handler_options=SignalHandlerOptions.NO,
    )
    node = SimulatorNode(parameter_overrides=overrides)
    gc.freeze()  # as the node's own process does
    executor = EventsExecutor()
    executor.add_node(node)
    driver = multiprocessing.get_context('spawn').Process(
        target=drive,
        args=(prefixes, bool(parameters.get('lockstep')), not given.without_readers),
        daemon=True,
    )
    driver.start()
    try:
        return _measured(node, executor, given.seconds, ending)
    finally:
        driver.terminate()  # softly: who is killed leaves shared memory behind
        driver.join()
        executor.remove_node(node)
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


def _measured(
    node: SimulatorNode, executor: Any, seconds: float, ending: Ending
) -> tuple[float, float]:
    simulation = node.simulation
    deadline = time.perf_counter() + 20.0
    while not all(abs(robot.odometry.speed_m_s) > 0.4 for robot in simulation.robots):
        if time.perf_counter() > deadline:
            raise SystemExit('the driver did not move the robots within 20 s')
        _spin_once(executor, ending)
    begin, begin_sec = time.perf_counter(), simulation.time_sec
    begin_cpu_sec = time.process_time()
    while time.perf_counter() - begin < seconds:
        _spin_once(executor, ending)
    passed_sec = simulation.time_sec - begin_sec
    wall_sec, cpu_sec = time.perf_counter() - begin, time.process_time() - begin_cpu_sec
    return passed_sec / wall_sec, passed_sec / cpu_sec


def _spin_once(executor: Any, ending: Ending) -> None:
    executor.spin_once(timeout_sec=0.1)
    if ending.asked:
        sys.exit(1)


def main() -> None:
    """Measure a row between two measurements of the bare model."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--robots', type=int, default=1, choices=range(1, len(STARTS) + 1))
    parser.add_argument('--parameters', type=json.loads, default={}, help='of the node, as JSON')
    parser.add_argument('--without-readers', action='store_true')
    parser.add_argument('--seconds', type=float, default=5.0, help='of every measurement')
    parser.add_argument('--without-bare', action='store_true', help='the node alone')
    given = parser.parse_args()
    alone = 0.0 if given.without_bare else bare(given.robots, given.seconds / 2.0)
    factor, cpu_factor = node_speed(given, Ending())
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    if not given.without_bare:
        alone = (alone + bare(given.robots, given.seconds / 2.0)) / 2.0
    package = str(Path(husky_sim_node.__file__).resolve().parent)
    print(
        json.dumps({'factor': factor, 'cpu_factor': cpu_factor, 'bare': alone, 'package': package})
    )


if __name__ == '__main__':
    main()
