# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A run with a limit ends by itself, also where its driver hangs; without one it says who does."""

from collections.abc import Callable
import time
from typing import Any

from geometry_msgs.msg import Twist
from husky_sim.ros import node as node_module
from husky_sim.ros import pace
from husky_sim.ros.node import SimulatorNode
from nav_msgs.msg import Odometry
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter


def run_until(
    domain_id: int, holds: Callable[[SimulatorNode], bool], *others: type[Node], **parameters: Any
) -> SimulatorNode:
    """Run a simulator, and other nodes beside it, until something holds."""
    context = Context()
    rclpy.init(context=context, domain_id=domain_id)
    overrides = [Parameter(name, value=value) for name, value in parameters.items()]
    simulator = SimulatorNode(context=context, parameter_overrides=overrides)
    nodes = [simulator, *(other('other', context=context) for other in others)]
    executor = SingleThreadedExecutor(context=context)
    for node in nodes:
        executor.add_node(node)
    deadline = time.monotonic() + 15.0
    try:
        while not holds(simulator):
            assert time.monotonic() < deadline, 'the condition does not hold after 15 s'
            executor.spin_once(timeout_sec=0.05)
    finally:
        executor.shutdown()
        for node in nodes:
            node.destroy_node()
        context.try_shutdown()
    return simulator


class AnswersOnce(Node):
    """A driver that hangs after its first command."""

    def __init__(self, name: str, **arguments: Any) -> None:
        super().__init__(name, **arguments)
        self._answered = False
        self._commands = self.create_publisher(Twist, 'husky_velocity_controller/cmd_vel', 10)
        self.create_subscription(Odometry, 'odometry/filtered', self._on_odometry, 10)

    def _on_odometry(self, _: Odometry) -> None:
        if not self._answered:
            self._answered = True
            self._commands.publish(Twist())


def is_over(simulator: SimulatorNode) -> bool:
    return bool(simulator.over.done())


def test_simulated_time_is_limited_to_the_period(
    domain_id: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pace, '_TURN_SEC', 0.5)  # to be over in the middle of a turn
    simulator = run_until(domain_id, is_over, real_time_factor=0.0, limit_sec=2.0)
    assert simulator.simulation.time_sec == pytest.approx(2.0, abs=1e-6)


def test_the_limit_is_told_as_it_was_given(
    domain_id: int, capfd: pytest.CaptureFixture[str]
) -> None:
    run_until(domain_id, is_over, real_time_factor=0.0, limit_sec=0.5)
    assert 'time is up after 0.5 s of simulated time' in capfd.readouterr().err


def test_without_a_limit_it_goes_on(domain_id: int) -> None:
    simulator = run_until(
        domain_id, lambda node: node.simulation.time_sec > 10.0, real_time_factor=0.0
    )
    assert not is_over(simulator)


def test_a_driver_that_hangs_in_lockstep_ends_the_run(
    domain_id: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pace, 'HANGING_SEC', 0.5)
    simulator = run_until(
        domain_id, is_over, AnswersOnce, lockstep=True, real_time_factor=0.0, limit_sec=100.0
    )
    assert simulator.simulation.time_sec < 1.0


@pytest.mark.parametrize(
    ('drivers', 'told'),
    [
        (
            (),
            'time begins when each robot has a driver, which reads its odometry/filtered and '
            'publishes its commands; so far nobody drives husky',
        ),
        ((AnswersOnce,), 'time waits for a command for each robot; no driver answers of husky'),
    ],
    ids=['nobody drives', 'the driver hangs'],
)
def test_whom_lockstep_waits_for_is_told_once(
    drivers: tuple[type[Node], ...],
    told: str,
    domain_id: int,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(node_module, 'DIAGNOSTICS_PERIOD_SEC', 0.05)
    said = ''
    told_at_sec: list[float] = []

    def has_had_time_to_repeat_it(_: SimulatorNode) -> bool:
        nonlocal said
        said += capfd.readouterr().err
        if told in said:
            told_at_sec.append(time.monotonic())
        return bool(told_at_sec) and told_at_sec[-1] - told_at_sec[0] > 1.0

    run_until(domain_id, has_had_time_to_repeat_it, *drivers, lockstep=True, real_time_factor=0.0)
    assert said.count('in lockstep time') == 1, said
