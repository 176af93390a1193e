# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle nodes: which there are, their states, their transitions.

The node that asks, `node`, is a node of rclpy or one of ros2cli. Answers are by the names of the
nodes that were asked; of one that did not answer, an exception stands there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from lifecycle_msgs.msg import State, Transition, TransitionDescription
from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from ros2cli import calls
from ros2node.api import get_node_names as get_all_node_names
from ros2node.api import NodeName
from ros2service.api import get_service_names_and_types

from ros2lifecycle.managed import has_lifecycle


def get_node_names(*, node: Any, include_hidden_nodes: bool = False) -> list[NodeName]:
    """List the nodes that have a lifecycle."""
    services = dict(
        get_service_names_and_types(node=node, include_hidden_services=include_hidden_nodes)
    )
    return [
        each
        for each in get_all_node_names(node=node, include_hidden_nodes=include_hidden_nodes)
        if has_lifecycle(each.full_name, services)
    ]


def call_get_states(*, node: Any, node_names: Iterable[str]) -> dict[str, State | Exception]:
    requests = {name: GetState.Request() for name in node_names}
    return _ask(node, GetState, 'get_state', requests, 'current_state')


def call_get_available_transitions(
    *, node: Any, states: Mapping[str, State | None]
) -> dict[str, list[TransitionDescription] | Exception]:
    """List what each node may do now; where a state is given, only what starts in it."""
    return _transitions(node, states, 'get_available_transitions')


def call_get_transition_graph(
    *, node: Any, states: Mapping[str, State | None]
) -> dict[str, list[TransitionDescription] | Exception]:
    """List all transitions of each node; where a state is given, only what starts in it."""
    return _transitions(node, states, 'get_transition_graph')


def call_change_states(
    *, node: Any, transitions: Mapping[str, Transition]
) -> dict[str, bool | Exception]:
    """Request a transition of each node, which may take long; return whether it was made."""
    requests = {name: ChangeState.Request(transition=each) for name, each in transitions.items()}
    return _ask(node, ChangeState, 'change_state', requests, 'success', may_take_long=True)


def _transitions(node: Any, states: Mapping[str, State | None], service: str) -> dict[str, Any]:
    requests = {name: GetAvailableTransitions.Request() for name in states}
    answers = _ask(node, GetAvailableTransitions, service, requests, 'available_transitions')
    for name, state in states.items():
        if state is not None and not isinstance(answers[name], Exception):
            answers[name] = [each for each in answers[name] if each.start_state == state]
    return answers


def _ask(
    node: Any,
    service_class: Any,
    service: str,
    requests: Mapping[str, Any],
    attribute: str,
    *,
    may_take_long: bool = False,
) -> dict[str, Any]:
    """Call a service of each node; return one attribute of each response."""
    named = {f'{name}/{service}': request for name, request in requests.items()}
    answers = calls.call_all(
        node,
        service_class,
        named,
        may_take_long=may_take_long,
        only_asks=service_class is not ChangeState,
    ).values()
    return {
        name: answer if isinstance(answer, Exception) else getattr(answer, attribute)
        for name, answer in zip(requests, answers, strict=True)
    }
