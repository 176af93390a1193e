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


@pytest.mark.parametrize('garbage', [b'', b'\0\1\0\0', b'\0\1\0\0' + bytes(40), b'\xff' * 52])
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
    assert 'husky: bytes that are no geometry_msgs/msg/Twist were no command: ' in printed
