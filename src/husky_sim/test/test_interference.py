# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Another publisher of commands, odometry or clock is named, on the terminal and in the record."""

from collections.abc import Callable, Iterator
from pathlib import Path
import time
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from husky_course.record import Disturbance, read_record
from husky_sim.ros.interference import GONE
from husky_sim.ros.node import SimulatorNode
from nav_msgs.msg import Odometry
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Empty

COMMANDS = '/husky_velocity_controller/cmd_vel'


class Run:
    """A simulator that keeps a record, and other nodes, each a participant of its own."""

    def __init__(self, domain_id: int, record: Path, **settings: str) -> None:
        self._domain_id = domain_id
        self._record = record
        self._contexts: list[Context] = []
        self._others: list[Node] = []
        self._simulator = SimulatorNode(
            context=self._context(),
            parameter_overrides=[
                Parameter(name, value=value)
                for name, value in {'record': str(record), **settings}.items()
            ],
        )
        self._executor = SingleThreadedExecutor(context=self._contexts[0])
        self._executor.add_node(self._simulator)

    def _context(self) -> Context:
        context = Context()
        rclpy.init(context=context, domain_id=self._domain_id)
        self._contexts.append(context)
        return context

    def publisher(
        self, kind: Any, topic: str, name: str, *, of_the_last_program: bool = False
    ) -> None:
        """Start a node that publishes a topic, and wait until the simulator sees it."""
        node = Node(name, context=self._contexts[-1] if of_the_last_program else self._context())
        node.create_publisher(kind, topic, 10)
        self._others.append(node)
        names = [other.get_name() for other in self._others]

        def is_seen() -> bool:
            seen = self._simulator.get_publishers_info_by_topic(topic)
            return [info.node_name for info in seen].count(name) == names.count(name)

        self.until(is_seen, f'{name} on {topic}')

    def command_once(self, name: str) -> None:
        """Let a node publish commands until the simulator takes one of them, no longer."""
        node = Node(name, context=self._context())
        publisher = node.create_publisher(Twist, COMMANDS, 10)
        (robot,) = self._simulator.simulation.robots
        command = Twist()
        command.linear.x = 0.25

        def is_taken() -> bool:
            publisher.publish(command)
            return robot.controller.asked_speed_m_s == command.linear.x

        self.until(is_taken, f'a command of {name}')
        node.destroy_node()

    def command_anew(self, name: str, *, times: int) -> None:
        """Let a node make a publisher for each of its commands, and end with two of them."""
        node = Node(name, context=self._context())
        publishers = []
        for _ in range(times):
            publishers.append(node.create_publisher(Twist, COMMANDS, 10))
            self.until(publishers[-1].get_subscription_count, 'the simulator')
            publishers[-1].publish(Twist())
            self.spin(seconds=0.04)
            if len(publishers) > 2:
                node.destroy_publisher(publishers.pop(0))
        node.destroy_node()
        node.context.shutdown()

    def until(self, holds: Callable[[], Any], what: str) -> None:
        deadline = time.monotonic() + 10.0
        while not holds():
            assert time.monotonic() < deadline, f'{what} did not come in 10 s'
            self._executor.spin_once(timeout_sec=0.05)

    def reset(self) -> None:
        """Call the service of the simulator."""
        client = self._simulator.create_client(Empty, '/husky_sim/reset')
        self.until(client.service_is_ready, 'the service reset')
        self.until(client.call_async(Empty.Request()).done, 'an answer of reset')

    def spin(self, *, seconds: float) -> None:
        """Let so much simulated time pass."""
        end_sec = self._simulator.simulation.time_sec + seconds
        self.until(lambda: self._simulator.simulation.time_sec > end_sec, 'simulated time')

    def close(self) -> None:
        self._executor.shutdown()
        for node in (*self._others, self._simulator):
            node.destroy_node()
        for context in self._contexts:
            context.try_shutdown()
        self._others.clear()

    def disturbances(self) -> tuple[Disturbance, ...]:
        self.close()
        return read_record(self._record).disturbances


@pytest.fixture
def run(domain_id: int, tmp_path: Path) -> Iterator[Run]:
    started = Run(domain_id, tmp_path / 'run.record')
    yield started
    started.close()


def test_one_publisher_of_commands_disturbs_nobody(run: Run) -> None:
    run.publisher(Twist, COMMANDS, 'driver')
    run.spin(seconds=0.5)
    assert run.disturbances() == ()


def test_a_second_publisher_of_commands_is_named(
    run: Run, capfd: pytest.CaptureFixture[str]
) -> None:
    run.publisher(Twist, COMMANDS, 'driver')
    run.spin(seconds=0.2)
    run.publisher(Twist, COMMANDS, 'stranger')
    run.spin(seconds=0.3)
    (line,) = [line for line in capfd.readouterr().err.splitlines() if 'stranger' in line]
    assert f'/driver and /stranger all publish {COMMANDS}' in line
    (found,) = run.disturbances()
    assert (found.topic, found.nodes) == (COMMANDS, ('/driver', '/stranger'))
    assert found.time_sec > 0.2


def test_nodes_of_one_program_are_one_driver(run: Run) -> None:
    run.publisher(Twist, COMMANDS, 'driver')
    run.publisher(Twist, COMMANDS, 'stopper', of_the_last_program=True)
    run.spin(seconds=0.3)
    assert run.disturbances() == ()


def test_who_makes_each_command_a_publisher_is_one_driver(run: Run) -> None:
    run.command_anew('driver', times=8)
    run.spin(seconds=0.5)
    assert run.disturbances() == ()


@pytest.mark.parametrize(
    ('kind', 'topic'),
    [
        (Odometry, '/odometry/filtered'),
        (Odometry, '/husky_velocity_controller/odom'),
        (Odometry, '/ground_truth/odom'),
        (Clock, '/clock'),
    ],
)
def test_whoever_speaks_for_the_simulator_is_named(run: Run, kind: Any, topic: str) -> None:
    run.publisher(kind, topic, 'liar')
    run.spin(seconds=0.3)
    (found,) = run.disturbances()
    assert (found.topic, found.nodes) == (topic, ('/liar',))


def test_a_driver_on_each_topic_of_commands_is_named(domain_id: int, tmp_path: Path) -> None:
    run = Run(domain_id, tmp_path / 'run.record', interface='clearpath')
    try:
        run.publisher(TwistStamped, '/cmd_vel', 'driver')
        run.spin(seconds=0.5)
        run.publisher(Twist, COMMANDS, 'stranger')
        run.spin(seconds=0.3)
        (found,) = run.disturbances()
        assert found.nodes == ('/driver', '/stranger')
        assert set(found.topic.split(' and ')) == {'/cmd_vel', COMMANDS}
        assert found.time_sec > 0.5
    finally:
        run.close()


def test_two_nodes_of_one_name_are_two(run: Run) -> None:
    run.publisher(Twist, COMMANDS, 'twin')
    run.publisher(Twist, COMMANDS, 'twin')
    run.spin(seconds=0.5)
    (found,) = run.disturbances()
    assert found.nodes == ('/twin', '/twin')


def test_who_still_disturbs_after_a_reset_is_named_again(run: Run) -> None:
    run.publisher(Twist, COMMANDS, 'driver')
    run.publisher(Twist, COMMANDS, 'stranger')
    run.spin(seconds=0.3)
    run.reset()
    run.spin(seconds=0.3)
    (found,) = run.disturbances()
    assert (found.topic, found.nodes) == (COMMANDS, ('/driver', '/stranger'))
    assert found.time_sec < 0.3


def test_a_publisher_of_a_moment_is_noticed(run: Run) -> None:
    run.publisher(Twist, COMMANDS, 'driver')
    run.spin(seconds=0.2)
    run.command_once('ghost')
    run.spin(seconds=0.5)
    (found, *_) = run.disturbances()
    assert found.topic == COMMANDS
    assert found.nodes[0] == '/driver'
    assert found.nodes[1] in ('/ghost', GONE)
