# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node where the middleware does not read what we pack: it publishes ordinary messages."""

from collections.abc import Iterator
import time
from typing import Any

from geometry_msgs.msg import Twist
from husky_sim.ros.node import SimulatorNode
from nav_msgs.msg import Odometry
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState, NavSatFix

CONTROL = 'husky_velocity_controller'
TOPICS = {
    'odometry/filtered': Odometry,
    f'{CONTROL}/odom': Odometry,
    f'{CONTROL}/cmd_vel_out': Twist,
    'ground_truth/odom': Odometry,
    'imu/data': Imu,
    'joint_states': JointState,
    'navsat/fix': NavSatFix,
    '/clock': Clock,
}


def refuse(*_: object) -> None:
    raise RuntimeError('failed to deserialize')


def stamp_ns(message: Any) -> int:
    stamp = message.clock if isinstance(message, Clock) else message.header.stamp
    return int(stamp.sec * 1_000_000_000 + stamp.nanosec)


class Stand:
    """A simulator, and a node that keeps the last message of every topic."""

    def __init__(self, domain_id: int) -> None:
        self.context = Context()
        rclpy.init(context=self.context, domain_id=domain_id)
        overrides = [Parameter('navsat_rate_hz', value=50.0)]
        self.simulator = SimulatorNode(context=self.context, parameter_overrides=overrides)
        self.probe = rclpy.create_node('probe', context=self.context)
        self.received: dict[str, Any] = {}
        for topic, kind in TOPICS.items():
            self.probe.create_subscription(kind, topic, self._hear(topic), 10)
        self.commands = self.probe.create_publisher(Twist, f'{CONTROL}/cmd_vel', 10)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.simulator)
        self.executor.add_node(self.probe)

    def _hear(self, topic: str) -> Any:
        return lambda message: self.received.__setitem__(topic, message)

    def drive(self, *, until_m_s: float) -> None:
        """Command until the robot is as fast and every topic was received."""
        command, deadline = Twist(), time.monotonic() + 20.0
        command.linear.x, command.angular.z = 0.8, 0.3
        robot = self.simulator.simulation.robots[0]
        while robot.odometry.speed_m_s < until_m_s or len(self.received) < len(TOPICS):
            assert time.monotonic() < deadline, f'{robot.odometry}, received {list(self.received)}'
            self.commands.publish(command)
            self.executor.spin_once(timeout_sec=0.02)

    def step(self) -> None:
        """Advance one period, and wait until every message of it was received."""
        self.simulator.pause(True)
        self.simulator.advance()
        now_ns, deadline = self.simulator.simulation.time_ns, time.monotonic() + 10.0
        stamped = [topic for topic, kind in TOPICS.items() if kind is not Twist]
        while missing := [t for t in stamped if stamp_ns(self.received[t]) != now_ns]:
            assert time.monotonic() < deadline, f'not received of {now_ns} ns: {missing}'
            self.executor.spin_once(timeout_sec=0.02)

    def close(self) -> None:
        self.executor.shutdown()
        self.probe.destroy_node()
        self.simulator.destroy_node()
        self.context.try_shutdown()


@pytest.fixture
def stand(domain_id: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[Stand]:
    monkeypatch.setattr('husky_sim.messages.packed_message.deserialize_message', refuse)
    made = Stand(domain_id)
    yield made
    made.close()


def test_every_topic_comes_and_one_line_says_how(
    capfd: pytest.CaptureFixture[str], stand: Stand
) -> None:
    stand.drive(until_m_s=0.3)
    stand.step()
    received, robot = stand.received, stand.simulator.simulation.robots[0]
    true = received['ground_truth/odom'].pose.pose.position
    assert (true.x, true.y, true.z) == tuple(robot.state.position)
    assert received['odometry/filtered'].pose.pose.position.x == robot.filtered.x
    assert received[f'{CONTROL}/odom'].twist.twist.linear.x == robot.odometry.speed_m_s > 0.25
    assert received[f'{CONTROL}/cmd_vel_out'].linear.x > 0.0
    assert tuple(received['joint_states'].velocity) == tuple(robot.wheels.speeds_rad_s)
    rate, fix = received['imu/data'].angular_velocity, robot.sensors.fix
    assert (rate.x, rate.y, rate.z) == tuple(robot.imu.angular_velocity)
    assert fix is not None
    assert received['navsat/fix'].latitude == fix[0]
    lines = [line for line in capfd.readouterr().err.splitlines() if 'another form' in line]
    assert len(lines) == 1
    assert ' has another form for nav_msgs/Odometry: failed to deserialize; publishing' in lines[0]
