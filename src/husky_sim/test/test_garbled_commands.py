# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Bytes that are no command, on the topic of commands, and a simulator that drives on."""

import time

from geometry_msgs.msg import Twist
from husky_sim.ros.node import SimulatorNode
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor

PERIOD_SEC = 0.1
NO_TWIST = 'husky: bytes that are no geometry_msgs/msg/Twist were no command: '
NO_NUMBER = 'husky: linear.x=nan, angular.z=nan: a velocity must be a finite number; stopping'
ON_CYCLONE = 'cyclone' in rclpy.get_rmw_implementation_identifier()
REFUSALS = {
    b'\0\1\0\0': NO_TWIST,
    b'\0\1\0\0' + bytes(40): NO_TWIST,
    b'\xff' * 52: NO_NUMBER if ON_CYCLONE else NO_TWIST,  # it asks no header
}
if not ON_CYCLONE:  # there rclpy itself fails, in every node, where it is to take nothing at all
    REFUSALS[b''] = NO_TWIST


@pytest.mark.parametrize('garbage', REFUSALS)
def test_bytes_that_are_no_command_stop_nothing(
    domain_id: int, capfd: pytest.CaptureFixture[str], garbage: bytes
) -> None:
    context = Context()
    rclpy.init(context=context, domain_id=domain_id)
    simulator = SimulatorNode(context=context)
    stranger = rclpy.create_node('stranger', context=context)
    publisher = stranger.create_publisher(Twist, 'husky_velocity_controller/cmd_vel', 10)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(simulator)
    command, deadline, next_sec = Twist(), time.monotonic() + 20.0, 0.0
    command.linear.x = 0.3
    odometry = simulator.simulation.robots[0].odometry
    while odometry.speed_m_s < 0.25:
        now_sec = time.monotonic()
        assert now_sec < deadline, f'the robot goes {odometry.speed_m_s} m/s'
        if now_sec >= next_sec:  # seldom enough that all is taken before the next
            next_sec = now_sec + PERIOD_SEC
            publisher.publish(garbage)
            publisher.publish(command)
        executor.spin_once(timeout_sec=0.02)
    executor.shutdown()
    stranger.destroy_node()
    simulator.destroy_node()
    context.try_shutdown()
    printed = capfd.readouterr().err
    assert 'Traceback' not in printed
    assert REFUSALS[garbage] in printed
