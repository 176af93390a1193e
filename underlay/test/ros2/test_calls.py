# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How long a command awaits the answer of a service."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import re
from typing import Any

from example_interfaces.action import Fibonacci
from playpen_testing.spinning import SpunNodes
import pytest
from rclpy.action import ActionServer
from rclpy.action.server import ServerGoalHandle
from rclpy.lifecycle import LifecycleNode
from rclpy.service import Service
from rclpy.task import Future
from ros2cli import calls
from ros2cli.errors import CommandError
from std_srvs.srv import SetBool


class Motor(LifecycleNode):
    """A node that offers a service, parameters, an action and states."""

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, **options)
        self.declare_parameter('gain', 2.0)
        self.create_service(SetBool, 'flip', self._flip)
        ActionServer(self, Fibonacci, 'count', self._count)

    def _flip(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success = request.data
        return response

    def _count(self, goal: ServerGoalHandle) -> Fibonacci.Result:
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1])


class SlowNode:
    """A node that is its own executor and client; the answer comes with the third spin."""

    service_name = '/motor/change_state'

    def __init__(self) -> None:
        self.executor = self
        self.future = Future()
        self.spins = 0

    def add_node(self, _: Any) -> bool:
        return False

    def spin_once(self, timeout_sec: float) -> None:
        self.spins += 1
        if self.spins == 3:
            self.future.set_result('configured')

    def create_client(self, *_: Any) -> Any:
        return self

    def destroy_client(self, _: Any) -> None:
        pass

    def service_is_ready(self) -> bool:
        return True

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return []

    def call_async(self, _: Any) -> Future:
        return self.future


def test_an_answer_that_may_take_long_is_awaited(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(calls, 'TIMEOUT_SEC', 0.0)
    monkeypatch.setattr(calls, 'SOON_SEC', 0.0)
    monkeypatch.setattr(calls, 'why_unanswered', lambda _: {})
    late = (
        "'/motor/change_state' gave no answer within 0 s; its node is busy or stopped, or "
        'waits in a callback for another one (`ros2 doctor` says more)'
    )
    with pytest.raises(CommandError, match=re.escape(late)):
        calls.call(SlowNode(), None, '/motor/change_state', None)
    assert capsys.readouterr().err == ''
    answer = calls.call(SlowNode(), None, '/motor/change_state', None, may_take_long=True)
    assert answer == 'configured'
    assert capsys.readouterr().err == f'hint: {late}; Ctrl-C ends the waiting\n'


class EndingNode(SlowNode):
    """One whose service is gone once it has been asked."""

    def __init__(self) -> None:
        super().__init__()
        self.looks = 0

    def service_is_ready(self) -> bool:
        self.looks += 1
        return self.looks < 3

    def spin_once(self, timeout_sec: float) -> None:
        pass


def test_a_node_that_has_ended_is_not_called_busy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calls, 'TIMEOUT_SEC', 0.0)
    monkeypatch.setattr(calls, 'SOON_SEC', 0.0)
    monkeypatch.setattr(calls, 'why_unanswered', lambda _: {})
    gone = "^'/motor/change_state' gave no answer: its node has ended, and its terminal says why"
    for may_take_long in (False, True):
        with pytest.raises(CommandError, match=gone):
            calls.call(
                EndingNode(), None, '/motor/change_state', None, may_take_long=may_take_long
            )


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (('service', 'call', '/flip', 'std_srvs/srv/SetBool', 'data: true'), 'success=True'),
        (('param', 'set', '/motor', 'gain', '3.0'), 'Set parameter successful'),
        (('lifecycle', 'set', '/motor', 'configure'), 'Transitioning successful'),
        (
            ('action', 'send_goal', '/count', 'example_interfaces/action/Fibonacci', 'order: 1'),
            'Goal finished with status: SUCCEEDED',
        ),
    ],
)
def test_a_server_has_found_the_client_that_makes_it_do_something(
    domain: int,
    ros2_here: Callable[..., Any],
    monkeypatch: pytest.MonkeyPatch,
    words: Sequence[str],
    said: str,
) -> None:
    asked: list[str] = []

    def lose_first(service: Service, *answer: Any) -> None:
        """Lose an answer, as rmw_fastrtps does where a client is found late."""
        if service.srv_name == 'motor/list_parameters' and not asked:
            asked.append('in vain')
            return
        if service.srv_name == 'motor/list_parameters':
            asked.append('answered')
        really_send(service, *answer)

    really_send = Service.send_response
    with SpunNodes(domain) as nodes:
        nodes.start(Motor, 'motor')
        monkeypatch.setattr(Service, 'send_response', lose_first)
        monkeypatch.setattr(calls, 'SOON_SEC', 20.0)  # whatever else the machine does
        answer = ros2_here(*words)
    assert said in answer.out, answer
    assert asked[:2] == ['in vain', 'answered']


def test_a_lost_answer_is_asked_for_again_where_asking_changes_nothing(
    processes: Any, ros2: Callable[..., Any]
) -> None:
    processes.node('loses_answers', 'motor')
    answer = ros2('param', 'get', '/motor', 'gain')
    assert (answer.status, answer.out) == (0, 'Double value is: 2.0\n'), answer
    answer = ros2('doctor')
    assert 'All 20 checks passed' in answer.lines, answer
    # To set what was set may do a second time what it did.
    processes.ros2(
        'param', 'set', '/motor', 'gain', '3.0', ready="hint: '/motor/set_parameters' gave no"
    )
    assert ros2('param', 'get', '/motor', 'gain').out == 'Double value is: 3.0\n'
