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
from ros2cli.node.direct import command_node
from ros2param import params
from rtps_graph.graph import Graph, Node


def check_answers(graph: Graph) -> Iterator[Finding]:
    """Ask each node for the names of its parameters, which one answers that spins."""
    for name, answer in _ask(graph, graph.nodes).items():
        if isinstance(answer, CommandError) and not isinstance(answer, ServiceTimeout):
            yield Finding(
                name,
                'answers nothing: it does not spin, or one of its callbacks does not return, as '
                'one that waits by call(), spin...() or sleep() for what another callback does',
                'spin it; in a callback use call_async() and a timer in the place of waiting',
            )


def parameter_names(graph: Graph) -> dict[str, set[str] | None]:
    """Map the nodes to the names of their parameters; to None where these are not told."""
    shown = [node for node in graph.nodes if not node.is_hidden]
    answers = _ask(graph, shown)
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


def _ask(graph: Graph, asked: Iterable[Node]) -> dict[str, Any]:
    """Map each node to its answer, or to why there is none; leave out those that cannot hear."""
    names = {node.full_name for node in asked if params.has_parameters(node)} - unheard(graph)
    if not names:
        return {}
    request = ListParameters.Request()
    with command_node() as node:
        answers = calls.call_all(
            node, ListParameters, {f'{name}/list_parameters': request for name in sorted(names)}
        )
    return {name.removesuffix('/list_parameters'): each for name, each in answers.items()}
