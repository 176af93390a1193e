# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Print how fast the simulator is beside bare mj_step of the same model, in the same run.

Every figure is a real-time factor: simulated seconds a second. The robots drive in circles. A
driver in a process of its own reads every topic, so that everything is published; in lockstep it
answers every odometry message.

Run it with:  ./lab exec python benchmark/simulation_speed.py [--seconds 5]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
import gc
import multiprocessing
import os
import time
from typing import Any

from geometry_msgs.msg import Twist
from husky_sim.domains import in_own_domain
from husky_sim.node import SimulatorNode
from husky_sim.world import default_worlds, load_world
import mujoco
from nav_msgs.msg import Odometry
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.parameter import Parameter
from sensor_msgs.msg import Imu, JointState, LaserScan, NavSatFix

from husky_sim.config import RobotStart

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


def _ignore(_: bytes) -> None:
    pass


def robots_named(count: int) -> list[RobotStart]:
    """Return robots at the first places."""
    return [RobotStart(name=f'r{i}', x=x, y=y) for i, (x, y) in enumerate(STARTS[:count])]


def bare(count: int, seconds: float) -> float:
    """Step the model and nothing else."""
    world = load_world(str(default_worlds() / 'playpen.xml'), robots_named(count))
    model, data = world.model, mujoco.MjData(world.model)
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
    """Command the robots: after every odometry message, or a hundred times a second."""
    rclpy.init()
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
    executor = EventsExecutor()
    executor.add_node(node)
    while rclpy.ok():
        executor.spin_once(timeout_sec=0.1)


def node_speed(count: int, seconds: float, *, reads: bool = True, **parameters: Any) -> float:
    """Run the simulator's node."""
    if count > 1:
        robots = robots_named(count)
        parameters['robots'] = [f'{r.name} {r.x} {r.y} {r.yaw}' for r in robots]
        prefixes = [f'{robot.name}/' for robot in robots]
    else:
        prefixes = ['']
    given = {'real_time_factor': 0.0, 'command_timeout_sec': 60.0, **parameters}
    overrides = [Parameter(name, value=value) for name, value in given.items()]
    rclpy.init()
    node = SimulatorNode(parameter_overrides=overrides)
    gc.freeze()  # as the node's own process does
    executor = EventsExecutor()
    executor.add_node(node)
    driver = multiprocessing.get_context('spawn').Process(
        target=drive, args=(prefixes, bool(given.get('lockstep')), reads), daemon=True
    )
    driver.start()
    try:
        return _measured(node, executor, seconds)
    finally:
        driver.terminate()  # softly: who is killed leaves shared memory behind
        driver.join()
        executor.remove_node(node)
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


def _measured(node: SimulatorNode, executor: Any, seconds: float) -> float:
    simulation = node.simulation
    deadline = time.perf_counter() + 20.0
    while not all(abs(robot.odometry.speed_m_s) > 0.4 for robot in simulation.robots):
        if time.perf_counter() > deadline:
            raise RuntimeError('the driver did not move the robots within 20 s')
        executor.spin_once(timeout_sec=0.1)
    begin, begin_sec = time.perf_counter(), simulation.time_sec
    while time.perf_counter() - begin < seconds:
        executor.spin_once(timeout_sec=0.1)
    return float((simulation.time_sec - begin_sec) / (time.perf_counter() - begin))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seconds', type=float, default=5.0, help='of every measurement')
    seconds = parser.parse_args().seconds
    rows: list[tuple[str, int, Callable[[], float]]] = [
        ('free running', 1, lambda: node_speed(1, seconds)),
        ('nobody reads', 1, lambda: node_speed(1, seconds, reads=False)),
        ('with lidar at 10 Hz', 1, lambda: node_speed(1, seconds, lidar_rate_hz=10.0)),
        (
            'lockstep with a driver',
            1,
            lambda: node_speed(1, seconds, lockstep=True, reads=False),
        ),
        ('free running', 3, lambda: node_speed(3, seconds)),
        ('free running', 10, lambda: node_speed(10, seconds)),
    ]
    print(f'{os.cpu_count()} cores, MuJoCo {mujoco.__version__}')
    print(
        f'{"simulator node":<24} {"robots":>6} {"x real time":>12} '
        f'{"bare mj_step":>13} {"part":>6}'
    )
    for name, count, measure in rows:
        alone = bare(count, seconds / 2.0)
        factor = measure()
        alone = (alone + bare(count, seconds / 2.0)) / 2.0
        print(f'{name:<24} {count:>6} {factor:>12.1f} {alone:>13.1f} {factor / alone:>6.0%}')


if __name__ == '__main__':
    with in_own_domain():
        main()
