# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""SIGINT ends commands that a script has started in the background, as upstream's: it is a node's.

A shell starts such jobs with the signal ignored.
"""

from __future__ import annotations

import signal
import sys
from typing import Any

import pytest

ROS2 = ('-m', 'ros2cli')
GOAL = ('/count', 'example_interfaces/action/Fibonacci', '{order: 9}')


@pytest.mark.parametrize(
    ('words', 'ready', 'status'),
    [
        ((*ROS2, 'topic', 'hz', '/nothing'), 'does not appear', signal.SIGINT),
        ((*ROS2, 'topic', 'bw', '/nothing'), 'does not appear', signal.SIGINT),
        ((*ROS2, 'topic', 'delay', '/nothing'), 'does not appear', signal.SIGINT),
        ((*ROS2, 'action', 'send_goal', *GOAL), 'Waiting for an action server', signal.SIGINT),
        (('-m', 'rqt_graph.main'), 'the live graph is at', 0),
        (('-m', 'tf2_tools.view_frames', '--live'), 'the live frames are at', 0),
    ],
)
def test_an_interrupt_ends_a_background_job(
    processes: Any, words: tuple[str, ...], ready: str, status: int
) -> None:
    job = processes.background(sys.executable, *words, ready=ready)
    job.send_signal(signal.SIGINT)
    job.communicate(timeout=10)
    assert job.returncode == status


def test_an_interrupt_cancels_the_goal_of_a_background_job(processes: Any) -> None:
    processes.node('count', 'server')
    words = (*ROS2, 'action', 'send_goal', *GOAL)
    client = processes.background(sys.executable, *words, ready='Goal accepted')
    client.send_signal(signal.SIGINT)
    out, _ = client.communicate(timeout=10)
    assert 'Goal canceled.' in out
