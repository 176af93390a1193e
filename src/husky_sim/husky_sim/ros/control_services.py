# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The services ~/reset, ~/pause and ~/step."""

from typing import Protocol

from rclpy.node import Node
from std_srvs.srv import Empty, SetBool, Trigger


class Run(Protocol):
    """What services control; `at_start`: no time has passed since the start or a reset."""

    @property
    def paused(self) -> bool: ...

    @property
    def at_start(self) -> bool: ...

    @property
    def time_sec(self) -> float: ...

    def pause(self, paused: bool) -> None: ...

    def step(self) -> None: ...

    def reset(self) -> None: ...


class ControlServices:
    """Offers the services of one run under its node."""

    def __init__(self, node: Node, run: Run) -> None:
        self._run = run
        node.create_service(Empty, '~/reset', self._on_reset)
        node.create_service(SetBool, '~/pause', self._on_pause)
        node.create_service(Trigger, '~/step', self._on_step)

    def _on_reset(self, _: Empty.Request, response: Empty.Response) -> Empty.Response:
        self._run.reset()
        return response

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._run.pause(request.data)
        response.success = True
        response.message = f'{"paused" if request.data else "going on"} at {self._now()}'
        return response

    def _on_step(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = self._run.paused
        if self._run.paused:
            self._run.step()
            response.message = f'stepped to {self._now()}'
        else:
            response.message = 'a step needs a paused simulation; call ~/pause with true first'
        return response

    def _now(self) -> str:
        return f'{self._run.time_sec:.2f} s of simulated time'
