# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Names that a program is told to replace, and that none of its nodes has."""

from __future__ import annotations

from collections.abc import Iterator
import re

from rtps_graph import names
from rtps_graph.graph import Graph, Node, Role

from ros2_diagnosis import command_lines, nearest
from ros2_diagnosis.finding import Finding

# design.ros2.org, static remapping: [NODE:][rostopic://]FROM:=TO, without wildcards.
_RULE = re.compile(
    r'(?:(?P<node>\w+):(?!//))?(?:(?:rostopic|rosservice)://)?(?P<old>[\w~/]+):=(?P<new>[\w~/]+)'
)
# Launch files tell these to every node of a robot, whether it has them or not.
_TOLD_TO_ALL = {'/tf', '/tf_static', 'tf', 'tf_static'}
_OF_EVERY_NODE = ('rcl_interfaces/', 'type_description_interfaces/')
_STATE = 'lifecycle_msgs/srv/GetState'


def check_remappings(graph: Graph) -> Iterator[Finding]:
    """Find rules whose new name no node of the program uses: they have replaced nothing.

    It is certain that they do not where the node has a name that is near to the old one; another
    may still come, and that of a lifecycle node with its configuration.
    """
    for line in command_lines.with_nodes_in(graph):
        for option, rule in line.options:
            match = _RULE.fullmatch(rule) if option in ('-r', '--remap') else None
            if match is None or match['old'].startswith('__') or match['old'] in _TOLD_TO_ALL:
                continue
            nodes = [node for node in line.nodes if match['node'] in (None, node.name)]
            if not nodes or any(_is_managed(node) for node in nodes):
                continue
            used = {each.name for node in nodes for each in node.endpoints}
            if used & {_expanded(match['new'], node) for node in nodes}:
                continue
            yield _told(
                f'{line.program} {option} {rule}', _expanded(match['old'], nodes[0]), nodes
            )


def _told(where: str, old: str, nodes: list[Node]) -> Finding:
    shown = ', '.join(sorted({node.full_name for node in nodes}))
    if any(old in {**node.action_servers(), **node.action_clients()} for node in nodes):
        return Finding(
            where,
            f'renames nothing: {old} of {shown} is an action, of which Jazzy renames parts alone',
            f'name each part, as `-r {old}/_action/send_goal:=NEW/_action/send_goal`, and so '
            'cancel_goal, get_result, feedback and status',
        )
    own = {name for node in nodes for name in _own_names(node)}
    return Finding(
        where,
        f'renames nothing: {shown} has no {old}',
        f'mend the name{nearest.hint(old, own)}',
        serious=bool(nearest.names(old, own)),
    )


def _is_managed(node: Node) -> bool:
    return any(_STATE in types for types in node.having(Role.SERVER).values())


def _own_names(node: Node) -> set[str]:
    """Return the topics and services of a node but those that each node has."""
    own = {each.name for each in node.endpoints if not each.type.startswith(_OF_EVERY_NODE)}
    return {name for name in own if not names.is_hidden(name)}


def _expanded(name: str, node: Node) -> str:
    """Return a name in full, as rcl does for a node."""
    if name.startswith('~'):
        return names.full_node_name(node.full_name, name[1:].lstrip('/'))
    return name if name.startswith('/') else names.full_node_name(node.namespace, name)
