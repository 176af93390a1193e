# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle nodes that nobody has configured or activated, and that therefore do nothing."""

from __future__ import annotations

from collections.abc import Iterator

from lifecycle_msgs.msg import State
from ros2_diagnosis.finding import Finding
from ros2cli.node.direct import command_node
from ros2lifecycle.api import call_get_states
from ros2lifecycle.managed import is_managed
from rtps_graph.graph import Graph

from ros2_doctor_checks import answers

# What each state that is at rest keeps a node from, and the transitions that lead on.
_AT_REST = {
    State.PRIMARY_STATE_UNCONFIGURED: (
        'it has not been configured, and may have no topics yet',
        ('configure', 'activate'),
    ),
    State.PRIMARY_STATE_INACTIVE: (
        'it has not been activated, and its lifecycle publishers send nothing',
        ('activate',),
    ),
}


def check_lifecycle(graph: Graph) -> Iterator[Finding]:
    """Ask each lifecycle node for its state."""
    shown = (node for node in graph.nodes if is_managed(node) and not node.is_hidden)
    names = sorted({node.full_name for node in shown} - answers.unheard(graph))
    if not names:
        return
    with command_node() as node:
        states = call_get_states(node=node, node_names=names)
    for name, state in states.items():
        if isinstance(state, Exception) or state.id not in _AT_REST:
            continue
        what, transitions = _AT_REST[state.id]
        commands = ', then '.join(f'`ros2 lifecycle set {name} {each}`' for each in transitions)
        yield Finding(name, f'is {state.label}: {what}', f'run {commands}', serious=False)
