# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 action send_goal`: Ctrl-C cancels the goal; what keeps it from a server is told."""

from __future__ import annotations

import os
import signal
import subprocess
from typing import Any

from playpen_testing.busy import sec_to_the_end
from playpen_testing.processes import find_line
import pytest

GOAL = ('action', 'send_goal', '/count', 'example_interfaces/action/Fibonacci', '{order: 9}')
END_WITHIN_SEC = 2.0


def _rest(client: subprocess.Popen[str]) -> str:
    """Return what is printed after an interrupt, within the time that one may take."""
    took_sec = sec_to_the_end(client.pid)
    out, _ = client.communicate(timeout=10)
    assert took_sec < END_WITHIN_SEC, out
    return out.lstrip('\n')  # an empty line may belong to what was read before


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_cancels_the_goal(processes: Any, number: int) -> None:
    server = processes.node('count', 'server')
    client = processes.ros2(*GOAL, ready='Goal accepted')
    client.send_signal(number)
    out = _rest(client)
    find_line(server.stdout, '^cancel$')
    assert out.startswith('Canceling goal...\nGoal canceled.\nResult:\n    sequence:\n')
    assert out.endswith('Goal finished with status: CANCELED\n')
    assert client.returncode == signal.SIGINT


def test_a_second_interrupt_does_not_spoil_it(processes: Any) -> None:
    processes.node('count', 'server')
    client = processes.ros2(*GOAL, ready='Goal accepted')
    client.send_signal(signal.SIGINT)
    find_line(client.stdout, '^Canceling goal')
    client.send_signal(signal.SIGINT)
    assert _rest(client).startswith('Goal canceled.')
    assert client.returncode == signal.SIGINT


@pytest.mark.parametrize(
    ('kind', 'printed'),
    [('count_that_stops_at_goal', 'Goal canceled.'), ('count_that_rejects', 'Goal was rejected.')],
)
def test_a_goal_without_an_answer_is_canceled_too(processes: Any, kind: str, printed: str) -> None:
    server = processes.node(kind, 'server')
    client = processes.ros2(*GOAL, ready='Sending goal')
    find_line(server.stdout, '^goal$')
    client.send_signal(signal.SIGINT)
    find_line(client.stdout, '^Canceling goal')
    os.waitid(os.P_PID, server.pid, os.WSTOPPED)  # it stops itself, after that line
    server.send_signal(signal.SIGCONT)
    assert _rest(client).startswith(printed)
    assert client.returncode == signal.SIGINT


@pytest.mark.parametrize(
    ('kind', 'last', 'printed'),
    [
        ('count_that_stops_at_goal', 'Sending goal', 'the server does not answer'),
        ('count_that_stops_at_cancel', 'Goal accepted', 'the server does not answer'),
        ('count_that_goes_on', 'Goal accepted', 'the server refuses'),
    ],
)
def test_a_goal_that_is_not_canceled_is_told(
    processes: Any, kind: str, last: str, printed: str
) -> None:
    server = processes.node(kind, 'server')
    client = processes.ros2(*GOAL, ready=last)
    find_line(server.stdout, '^goal$')
    client.send_signal(signal.SIGINT)
    out = _rest(client)
    assert f'Failed to cancel goal: {printed}' in out
    assert 'Traceback' not in out
    assert client.returncode == 1


@pytest.mark.usefixtures('processes')
def test_an_interrupt_ends_the_wait_for_a_server(processes: Any) -> None:
    client = processes.ros2(*GOAL, ready='Waiting for an action server')
    client.send_signal(signal.SIGINT)
    assert _rest(client) == ''
    assert client.returncode == signal.SIGINT


def test_a_goal_that_takes_too_long_is_canceled(processes: Any, ros2: Any) -> None:
    processes.node('count', 'server')
    answer = ros2(*GOAL, '--timeout', '1')
    assert 'Goal canceled.' in answer.lines
    assert answer.err == 'No result within 1 s: the goal was canceled\n'
    assert answer.status == 1


def test_the_timeout_ends_the_wait_for_an_answer_too(processes: Any) -> None:
    processes.node('count_that_stops_at_goal', 'server')
    client = processes.ros2(*GOAL, '--timeout', '0.5')
    out, _ = client.communicate(timeout=20)
    assert out.endswith(
        'Failed to cancel goal: the server does not answer, and may still carry it out\n'
    )
    assert client.returncode == 1


def test_a_server_that_ends_before_its_goal_is_told(processes: Any) -> None:
    server = processes.node('count', 'server')
    client = processes.ros2(*GOAL, ready='Goal accepted')
    server.send_signal(signal.SIGINT)
    find_line(client.stdout, '^hint: /count: its server has ended, so that no result comes')
    client.send_signal(signal.SIGINT)
    assert 'Failed to cancel goal: the server does not answer' in _rest(client)


def test_a_goal_for_a_name_that_nobody_has_gets_a_hint(processes: Any) -> None:
    processes.node('count', 'server')
    hint = "hint: nobody offers '/cont'; did you mean '/count'?"
    client = processes.ros2(*GOAL[:2], '/cont', *GOAL[3:], ready=hint)
    client.send_signal(signal.SIGINT)
    assert _rest(client) == ''


def test_a_goal_of_another_type_gets_a_hint(processes: Any, ros2: Any) -> None:
    processes.node('count', 'server')
    told = (
        '/count: /server offers example_interfaces/action/Fibonacci, but a `ros2` command calls '
        'turtlesim/action/RotateAbsolute, so that no call arrives'
    )
    words = (*GOAL[:3], 'turtlesim/action/RotateAbsolute', '{}')
    processes.ros2(*words, ready=f'hint: {told}')
    found = ros2('doctor').lines
    assert sum(told in line for line in found) == 1
    assert sum('(types)' in line for line in found) == 1
    answer = ros2(*words, '--timeout', '0.5')
    assert answer.err.splitlines()[-1] == "No action server for '/count' within 0.5 s"
