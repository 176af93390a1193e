# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The services and parameters of the simulator, as the live view uses them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
import time
from typing import Any

from husky_course.robot import RobotStart
from husky_sim.errors import SimulatorError
from husky_sim.world import default_worlds
from rcl_interfaces.msg import Parameter, ParameterEvent, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.node import Node
from rclpy.qos import qos_profile_parameter_events
from rclpy.task import Future
from std_srvs.srv import Empty, SetBool, Trigger

ANSWER_SEC = 2.0
"""A request without an answer is repeated after this time."""

_FACTOR = 'real_time_factor'
_PARAMETERS = ['world', 'x', 'y', 'yaw', 'robots']


class SimulatorQuery:
    """Asks a simulator which world and robots it runs. Nothing here blocks."""

    def __init__(self, node: Node, name: str) -> None:
        self.name = name
        self._client = node.create_client(GetParameters, f'{name}/get_parameters')
        self._request: Future[Any] | None = None
        self._due_sec = 0.0

    def poll(self) -> tuple[str, tuple[RobotStart, ...]] | None:
        """
        Return the world's file and the robots if an answer has come; else ask where due.

        :raises SimulatorError: if what answers is no simulator.
        """
        now = time.monotonic()
        if self._request is None or now > self._due_sec:
            self._due_sec = now + ANSWER_SEC
            if self._client.service_is_ready():
                self._request = self._client.call_async(GetParameters.Request(names=_PARAMETERS))
            else:
                self._request = None
        elif self._request.done():
            answer, self._request = self._request.result(), None
            try:
                return _world_and_robots(answer)
            except ValueError:
                raise SimulatorError(
                    f'simulator={self.name!r}: this node is no simulator; give the name of one, '
                    'as of husky_sim'
                ) from None
        return None


def _world_and_robots(answer: GetParameters.Response) -> tuple[str, tuple[RobotStart, ...]]:
    """
    Read what a simulator answers.

    :raises ValueError: if it is none: it lacks one of the parameters, or names no robots in it.
    """
    world, x, y, yaw, robots = answer.values
    starts = tuple(RobotStart.parse(line) for line in robots.string_array_value if line.strip())
    one = RobotStart(x=_number(x), y=_number(y), yaw=_number(yaw))
    return world.string_value or str(default_worlds() / 'playpen.xml'), starts or (one,)


def _number(value: ParameterValue) -> float:
    # A person may have written 1 for 1.0.
    if value.type == ParameterType.PARAMETER_INTEGER:
        return float(value.integer_value)
    return float(value.double_value)


class SimulatorControl:
    """
    Controls a running simulator. Nothing here blocks.

    `factor` is its real-time factor, whoever has set it; None until that is known.

    :param refused: called with what could not be done and why.
    :param closing: destroys the clients.
    """

    def __init__(
        self, node: Node, name: str, refused: Callable[[str, str], None], closing: ExitStack
    ) -> None:
        self._name = name
        self._refused = refused
        self.factor: float | None = None

        def create_client(kind: Any, service: str) -> Any:
            client = node.create_client(kind, f'{name}/{service}')
            closing.callback(node.destroy_client, client)
            return client

        self._get = create_client(GetParameters, 'get_parameters')
        self._set = create_client(SetParameters, 'set_parameters')
        self._pause = create_client(SetBool, 'pause')
        self._step = create_client(Trigger, 'step')
        self._reset = create_client(Empty, 'reset')
        events = node.create_subscription(
            ParameterEvent, '/parameter_events', self._on_parameters, qos_profile_parameter_events
        )
        closing.callback(node.destroy_subscription, events)

    def poll_factor(self) -> None:
        """Ask for the real-time factor where it is not known; once set, it is heard of."""
        if self.factor is not None or not self._get.service_is_ready():
            return

        def on_answer(answer: Future[Any]) -> None:
            self.factor = _number(answer.result().values[0])

        self._get.call_async(GetParameters.Request(names=[_FACTOR])).add_done_callback(on_answer)

    def _on_parameters(self, msg: ParameterEvent) -> None:
        if not msg.node.endswith(f'/{self._name}'):
            return
        for parameter in (*msg.new_parameters, *msg.changed_parameters):
            if parameter.name == _FACTOR:
                self.factor = _number(parameter.value)

    def pause(self, paused: bool) -> None:
        """Pause, or go on."""
        self._call('Pause', self._pause, SetBool.Request(data=paused))

    def step(self) -> None:
        """Advance a paused simulation by one control period."""
        self._call('Step', self._step, Trigger.Request())

    def reset(self, then: Callable[[], None] | None = None) -> None:
        """Put everything back to the start; `then` is called when it is done."""
        self._call('Reset', self._reset, Empty.Request(), then)

    def set_factor(self, factor: float) -> None:
        """Set the real-time factor; 0 is as fast as possible."""
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=factor)
        parameter = Parameter(name=_FACTOR, value=value)
        self._call('Speed', self._set, SetParameters.Request(parameters=[parameter]))

    def _call(
        self, what: str, client: Any, request: Any, then: Callable[[], None] | None = None
    ) -> None:
        if not client.service_is_ready():
            self._refused(what, f'{self._name} does not answer: is the simulator running?')
            return

        def on_done(future: Future[Any]) -> None:
            for result in getattr(future.result(), 'results', [future.result()]):
                if not getattr(result, 'successful', getattr(result, 'success', True)):
                    reason = getattr(result, 'reason', '') or getattr(result, 'message', '')
                    self._refused(what, reason)
                    return
            if then is not None:
                then()

        client.call_async(request).add_done_callback(on_done)
