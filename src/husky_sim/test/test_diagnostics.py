# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is told of the pace, over DDS: a machine is blamed only for what it does."""

from collections.abc import Callable, Iterator
from pathlib import Path
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from husky_sim.ros.node import SimulatorNode
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.task import Future
from std_srvs.srv import Empty, SetBool


class Run:
    """A simulator and an operator, whom one executor serves in this thread."""

    def __init__(self, domain_id: int, world: Path) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain_id)
        overrides = [Parameter('world', value=str(world))]
        self.simulator = SimulatorNode(context=self._context, parameter_overrides=overrides)
        self._operator = Node('operator', context=self._context)
        self._parameters = AsyncParameterClient(self._operator, '/husky_sim')
        self.told: list[DiagnosticStatus] = []
        self._operator.create_subscription(DiagnosticArray, '/diagnostics', self._on_told, 10)
        self._executor = SingleThreadedExecutor(context=self._context)
        for node in (self.simulator, self._operator):
            self._executor.add_node(node)

    def _on_told(self, message: DiagnosticArray) -> None:
        self.told.append(message.status[0])

    def until(self, holds: Callable[[], Any], what: str) -> None:
        deadline = time.monotonic() + 15.0
        while not holds():
            assert time.monotonic() < deadline, f'{what} did not come in 15 s'
            self._executor.spin_once(timeout_sec=0.05)

    def next_status(self) -> DiagnosticStatus:
        count = len(self.told)
        self.until(lambda: len(self.told) > count, 'diagnostics')
        return self.told[count]

    def spin(self, *, seconds: float) -> None:
        """Let so much simulated time pass."""
        end_sec = self.simulator.time_sec + seconds
        self.until(lambda: self.simulator.time_sec > end_sec, 'simulated time')

    def reset(self) -> None:
        self._call(Empty, 'reset', Empty.Request())

    def pause(self) -> None:
        """Pause for three tenths of a second, and go on."""
        self._call(SetBool, 'pause', SetBool.Request(data=True))
        end_sec = time.monotonic() + 0.3
        self.until(lambda: time.monotonic() > end_sec, 'the end of the pause')
        self._call(SetBool, 'pause', SetBool.Request(data=False))

    def go_faster(self) -> None:
        self.set_pace(2.0)

    def set_pace(self, factor: float) -> None:
        self.until(self._parameters.services_are_ready, 'the services of parameters')
        pace = [Parameter('real_time_factor', value=factor)]
        answer: Future[Any] = self._parameters.set_parameters(pace)
        self.until(answer.done, 'an answer')

    def _call(self, kind: Any, name: str, request: Any) -> None:
        client = self._operator.create_client(kind, f'/husky_sim/{name}')
        self.until(client.service_is_ready, f'the service {name}')
        self.until(client.call_async(request).done, f'an answer of {name}')

    def close(self) -> None:
        self._executor.shutdown()
        self._operator.destroy_node()
        self.simulator.destroy_node()
        self._context.try_shutdown()


@pytest.fixture
def run(domain_id: int, worlds: Path) -> Iterator[Run]:
    started = Run(domain_id, worlds / 'empty.xml')
    yield started
    started.close()


@pytest.mark.parametrize('act', [Run.reset, Run.pause, Run.go_faster])
def test_the_machine_is_not_blamed_for_what_a_person_does(
    run: Run, act: Callable[[Run], None]
) -> None:
    run.next_status()
    run.spin(seconds=0.4)  # into the middle of what the next message tells of
    act(run)
    status = run.next_status()
    assert status.level == DiagnosticStatus.OK, status.message
    assert float(status.values[0].value) >= 0.0


def test_a_pace_of_fewer_periods_than_messages_is_kept(run: Run) -> None:
    run.set_pace(0.01)  # a control period in two seconds
    for _ in range(4):
        status = run.next_status()
        assert status.level == DiagnosticStatus.OK, status.message
