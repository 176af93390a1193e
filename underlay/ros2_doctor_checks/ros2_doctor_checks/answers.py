# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes that are there, but whose callbacks are not called."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from rcl_interfaces.srv import ListParameters
from ros2_diagnosis import nodes
from ros2_diagnosis.finding import Finding
from ros2cli import calls
from ros2cli.errors import CommandError, ServiceTimeout
from ros2cli.node.direct import command_node, CommandNode
from ros2param import params
from rtps_graph.graph import Graph, Node

_SERVICE = '/list_parameters'
_SLOW_SEC = 0.5
"""So long a node that spins on a busy machine does not take to answer."""


def check_answers(graph: Graph) -> Iterator[Finding]:
    """Ask each node for the names of its parameters, which one answers that spins."""
    asked = _that_hear(graph, graph.nodes)
    if not asked:
        return
    with command_node() as node:
        answers, took_sec = _ask(node, asked)
        if len(took_sec) < len(answers):  # Then the others' answers have come long ago.
            _, took_sec = _ask(node, took_sec)
        slow = _slow(node, took_sec)
    for name, answer in answers.items():
        if isinstance(answer, CommandError) and not isinstance(answer, ServiceTimeout):
            yield Finding(
                name,
                'answers nothing: it does not spin, or one of its callbacks does not return, as '
                'one that waits by call(), spin...() or sleep() for what another callback does',
                'spin it; in a callback use call_async() and a timer in the place of waiting',
            )
    for name, sec in slow.items():
        yield Finding(
            name,
            f'answers after {sec:.1f} s: one of its callbacks takes long, and the others wait',
            'use a timer in the place of sleep(), and a thread of its own for what takes long',
            serious=False,
        )


def _slow(node: CommandNode, took_sec: dict[str, float]) -> dict[str, float]:
    """Map those that answer late to how late, of those that have answered just now.

    Once may be by chance, and the first time may come at the end of what takes long.
    """
    for _ in range(2):
        _, took_sec = _ask(node, took_sec)
        took_sec = {name: sec for name, sec in took_sec.items() if sec > _SLOW_SEC}
    return took_sec


def parameter_names(graph: Graph) -> dict[str, set[str] | None]:
    """Map the nodes to the names of their parameters; to None where these are not told."""
    shown = [node for node in graph.nodes if not node.is_hidden]
    with command_node() as node:
        answers, _ = _ask(node, _that_hear(graph, shown))
    told = {
        name: set(answer.result.names)
        for name, answer in answers.items()
        if not isinstance(answer, Exception)
    }
    return {node.full_name: told.get(node.full_name) for node in shown}


def unheard(graph: Graph) -> set[str]:
    """Name the nodes whose services no call from here reaches."""
    apart = [*nodes.check_vendors(graph), *nodes.check_memory(graph.nodes)]
    return {name for finding in apart for name in finding.where.split(', ')}


def _that_hear(graph: Graph, among: Iterable[Node]) -> set[str]:
    """Name those that have parameters, and that a call from here reaches."""
    return {node.full_name for node in among if params.has_parameters(node)} - unheard(graph)


def _ask(node: CommandNode, names: Iterable[str]) -> tuple[dict[str, Any], dict[str, float]]:
    """Map each to its answer, or to why there is none; and those that answer to when, in s."""
    services = {f'{name}{_SERVICE}': ListParameters.Request() for name in sorted(names)}
    took_sec: dict[str, float] = {}
    answers = calls.call_all(node, ListParameters, services, only_asks=True, took_sec=took_sec)
    return (
        {name.removesuffix(_SERVICE): answer for name, answer in answers.items()},
        {name.removesuffix(_SERVICE): sec for name, sec in took_sec.items()},
    )
