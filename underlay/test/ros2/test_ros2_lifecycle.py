# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 lifecycle` with a node that has a lifecycle, one that is hidden, and one without."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest


@pytest.fixture(scope='module', autouse=True)
def world(shared_processes: Any) -> None:
    shared_processes.node('managed', 'motor')
    shared_processes.node('managed', '_secret')
    shared_processes.node('plain', 'plain')


def test_nodes_with_a_lifecycle_are_listed(
    ros2: Callable[..., Any], ros2_here: Callable[..., Any]
) -> None:
    assert ros2('lifecycle', 'nodes').lines == ['/motor']
    assert ros2_here('lifecycle', 'nodes', '-a').lines == ['/_secret', '/motor']
    assert ros2_here('lifecycle', 'nodes', '--all', '--count-nodes').out == '2\n'
    assert ros2_here('lifecycle', 'get', '--include-hidden-nodes').lines == [
        '/_secret: unconfigured [1]',
        '/motor: unconfigured [1]',
    ]


def test_a_node_goes_where_it_is_sent(
    ros2: Callable[..., Any], ros2_here: Callable[..., Any]
) -> None:
    idle = []
    for ask, transition, state in (
        (ros2, 'configure', 'inactive [2]'),
        (ros2_here, '2', 'unconfigured [1]'),
    ):
        assert ask('lifecycle', 'set', 'motor', transition).out == 'Transitioning successful\n'
        assert ask('lifecycle', 'get', '/motor').out == f'{state}\n'
        idle.append(ros2_here('doctor').of_check('lifecycle'))
    assert idle == [
        'note (lifecycle): /motor: is inactive: it has not been activated, and its lifecycle '
        'publishers send nothing; run `ros2 lifecycle set /motor activate`',
        'note (lifecycle): /motor: is unconfigured: it has not been configured, and may have no '
        'topics yet; run `ros2 lifecycle set /motor configure`, then '
        '`ros2 lifecycle set /motor activate`',
    ]


def test_transitions_are_listed(ros2: Callable[..., Any], ros2_here: Callable[..., Any]) -> None:
    now = ros2('lifecycle', 'list', 'motor').lines
    assert now[:3] == ['- configure [1]', '\tStart: unconfigured', '\tGoal: configuring']
    assert '- activate [3]' not in now
    assert '- activate [3]' in ros2_here('lifecycle', 'list', 'motor', '--all').lines


@pytest.mark.parametrize(
    ('words', 'message'),
    [
        (('set', '/motor', 'jump'), 'Unknown transition requested, available ones are:\n- con'),
        (('get', '/moter'), "Node not found: '/moter'; did you mean '/motor'?"),
        (('get', '/_secret'), "Node not found: '/_secret'"),
        (('list', '/plain'), "Node not found: '/plain' is there, but has no lifecycle"),
    ],
)
def test_what_cannot_be_done_is_said(
    ros2_here: Callable[..., Any], words: tuple[str, ...], message: str
) -> None:
    answer = ros2_here('lifecycle', *words)
    assert answer.status == 1
    assert message in answer.err
