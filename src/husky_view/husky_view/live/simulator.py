# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator as the view's node knows it: its world, and the services that control it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from husky_course.robot import RobotStart
from husky_sim.world import default_worlds
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Empty, SetBool, Trigger

_ASKED = ('world', 'x', 'y', 'yaw', 'robots')


class SimulatorLink:
    """
    Asks and controls a running simulator. Nothing here waits.

    :param refused: called with what could not be done and why.
    """

    def __init__(self, node: Node, name: str, refused: Callable[[str, str], None]) -> None:
        self.name = name
        self._refused = refused
        self._get = node.create_client(GetParameters, f'{name}/get_parameters')
        self._set = node.create_client(SetParameters, f'{name}/set_parameters')
        self._pause = node.create_client(SetBool, f'{name}/pause')
        self._step = node.create_client(Trigger, f'{name}/step')
        self._reset = node.create_client(Empty, f'{name}/reset')

    def ask(self) -> Future[Any] | None:
        """Ask for the world and the robots; None while nobody is there to answer."""
        if not self._get.service_is_ready():
            return None
        return self._get.call_async(GetParameters.Request(names=list(_ASKED)))

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
        """Choose how fast time passes; 0 is as fast as possible."""
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=factor)
        parameter = Parameter(name='real_time_factor', value=value)
        self._call('Speed', self._set, SetParameters.Request(parameters=[parameter]))

    def _call(
        self, what: str, client: Any, request: Any, then: Callable[[], None] | None = None
    ) -> None:
        if not client.service_is_ready():
            self._refused(what, f'{self.name} does not answer: is the simulator running?')
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


def world_and_robots(answer: GetParameters.Response) -> tuple[str, tuple[RobotStart, ...]]:
    """Read which world the simulator runs and where its robots started."""
    world, x, y, yaw, robots = answer.values
    starts = tuple(RobotStart.parse(line) for line in robots.string_array_value if line.strip())
    one = RobotStart(x=_number(x), y=_number(y), yaw=_number(yaw))
    return world.string_value or str(default_worlds() / 'playpen.xml'), starts or (one,)


def _number(value: ParameterValue) -> float:
    # A person may have written 1 for 1.0.
    if value.type == ParameterType.PARAMETER_INTEGER:
        return float(value.integer_value)
    return float(value.double_value)
