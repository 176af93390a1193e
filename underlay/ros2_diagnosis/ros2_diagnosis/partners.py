# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Topics and services that only one side uses, while the other side uses another name."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from rtps_graph import names
from rtps_graph.graph import Graph, Role

from ros2_diagnosis import nearest
from ros2_diagnosis.finding import Finding
from ros2_diagnosis.nodes import COMMAND, SEND_GOAL, shown_name

# Types of so many uses that they tell nothing: with one of them the names must be near, too.
_OF_ANY_USE = ('std_msgs/', 'std_srvs/', 'example_interfaces/')
# The types of the services that nodes have of their own: who calls one means that node.
_OF_A_NODE = ('rcl_interfaces/', 'type_description_interfaces/', 'lifecycle_msgs/')
_SIMULATOR = 'husky_sim'
_VIEW = '/husky_view'  # shows each sensor that there is
_SHOWN = 3
# What the simulator publishes only where it is asked to, by the end of the topic.
_LASER, _CAMERA, _BATTERY = 'lidar_rate_hz:=10.0', 'camera_rate_hz:=5.0', 'battery:=true'
_OFF_AT_FIRST = {
    'front/scan': _LASER,
    'lidar2d_0/scan': _LASER,
    'camera/image_raw': _CAMERA,
    'camera/camera_info': _CAMERA,
    'camera_0/color/image': _CAMERA,
    'camera_0/color/camera_info': _CAMERA,
    'battery_state': _BATTERY,
    'platform/bms/state': _BATTERY,
}
# The same by the type, for who waits under another name.
_OFF_BY_TYPE = {
    'sensor_msgs/msg/LaserScan': ('laser', _LASER),
    'sensor_msgs/msg/Image': ('camera', _CAMERA),
    'sensor_msgs/msg/CameraInfo': ('camera', _CAMERA),
    'sensor_msgs/msg/BatteryState': ('battery', _BATTERY),
}


@dataclass(frozen=True)
class _Use:
    """That a node uses a topic or service, told once however often it does."""

    node: str
    name: str
    type: str


_Uses = tuple[_Use, ...]


def check_topics(graph: Graph) -> Iterator[Finding]:
    """Find publishers and subscriptions of one type that miss each other by their names.

    It is no fault, but worth knowing, where the publisher is heard by others.
    """
    publishers = _uses(graph, Role.PUBLISHER)
    subscriptions = _uses(graph, Role.SUBSCRIPTION)
    heard = {each.name for each in subscriptions}
    words = ('subscribes to', 'publishes', 'so that nothing arrives')
    for waiting, found in _waiting(subscriptions, publishers):
        unheard = tuple(each for each in found if each.name not in heard)
        if found:
            yield _apart(graph, waiting, unheard or found, words, serious=bool(unheard))
        else:
            yield from _sensors_that_are_off(graph, waiting)


def check_services(graph: Graph) -> Iterator[Finding]:
    """Find clients of services and actions that nobody offers."""
    words = ('calls', 'offers', 'so that no call arrives')
    clients, servers = _uses(graph, Role.CLIENT), _uses(graph, Role.SERVER)
    of_nodes = [each for each in clients if each.type.startswith(_OF_A_NODE)]
    yield from _nodes_that_are_not_there(graph, of_nodes, servers)
    others = [each for each in clients if each not in of_nodes]
    for waiting, found in _waiting(others, servers):
        if found:
            yield _apart(graph, waiting, found, words)
            continue
        for each in waiting:
            yield Finding(
                each.name,
                f'{each.node} calls this, {each.type}, which nobody offers',
                'start the node that offers it',
                serious=False,
            )


def _nodes_that_are_not_there(
    graph: Graph, clients: list[_Use], servers: list[_Use]
) -> Iterator[Finding]:
    """Find the nodes that others ask for what every node has, as for its parameters."""
    offered = {each.name for each in servers}
    asked: dict[tuple[str, str], list[str]] = {}
    for each in clients:
        if each.name not in offered:
            node, _, service = each.name.rpartition('/')
            asked.setdefault((each.node, node), []).append(service)
    there = {node.full_name for node in graph.nodes if not node.is_hidden}
    for (caller, node), services in asked.items():
        called = f'{caller} calls {", ".join(services[:_SHOWN])} of this node'
        near = nearest.names(node, there - {caller})
        if node in there:
            yield Finding(
                node, f'{called}, which does not offer it', 'ask another one', serious=False
            )
        else:
            yield Finding(
                node,
                f'{called}, which is not there{nearest.hint(node, near)}',
                'start it, or give its name in full, as `ros2 node list` shows it',
                serious=bool(near),
            )


def _uses(graph: Graph, role: Role) -> list[_Use]:
    """List who uses what in a role; an action is what sends its goals, without the suffix."""
    found = {
        _Use(
            shown_name(graph.node_of(endpoint)),
            endpoint.name.removesuffix(SEND_GOAL),
            endpoint.type.removesuffix('_SendGoal'),
        )
        for endpoint in graph.endpoints
        if endpoint.role is role
    }
    return sorted(
        (each for each in found if not names.is_hidden(each.name)),
        key=lambda each: (each.name, each.node),
    )


def _waiting(uses: list[_Use], partners: list[_Use]) -> Iterator[tuple[_Uses, _Uses]]:
    """Yield what has no partner, and what it may have been meant for.

    What a node waits for in the same way for each of several robots comes together.
    """
    there = {each.name for each in partners}
    together: dict[tuple[str, str, _Uses], list[_Use]] = {}
    for each in uses:
        if each.name not in there:
            found = _meant(each, partners, uses)
            together.setdefault((each.node, each.type, found), []).append(each)
    for (_, _, found), waiting in together.items():
        yield tuple(waiting), found


def _meant(one: _Use, partners: list[_Use], same_side: list[_Use]) -> _Uses:
    """Return what a use may have been meant for.

    That is of the same type and another node, and this node does not use it already. Where no
    name is near, it is no node either that uses this type on both sides: that one passes it on.
    """
    used = {each.name for each in same_side if each.node == one.node}
    on_both_sides = {each.node for each in same_side if each.type == one.type}
    found = tuple(
        each
        for each in partners
        if each.type == one.type and each.node != one.node and each.name not in used
    )
    near = nearest.names(one.name, {each.name for each in found})
    if near or one.type.startswith(_OF_ANY_USE):
        return tuple(each for each in found if each.name in near)
    return tuple(each for each in found if each.node not in on_both_sides)


def _apart(
    graph: Graph,
    waiting: _Uses,
    found: _Uses,
    words: tuple[str, str, str],
    *,
    serious: bool = True,
) -> Finding:
    """Tell uses of a node from those that they may have been meant for.

    :param words: what the one does, what the others do, what follows from it.
    """
    does, others_do, follows = words
    others = ' and '.join(f'{each.node} {others_do} {each.name}' for each in found[:_SHOWN])
    sizes = {shown_name(node): len(node.endpoints) for node in graph.nodes}
    # A driver is rather to be told other names than the robot, which has more of them.
    one, other = sorted((waiting[0], found[0]), key=lambda each: sizes.get(each.node, 0))
    renamed = f'start {one.node} with `--ros-args -r {one.name}:={other.name}`'
    return Finding(
        ', '.join(each.name for each in waiting[:_SHOWN]),
        f'{waiting[0].node} {does} this, but {others}, of one type, {waiting[0].type}, {follows}',
        'use one name in both' if one.node == COMMAND else f'use one name in both, or {renamed}',
        serious=serious,
    )


def how_to_switch_on(graph: Graph, topic: str) -> str:
    """Return what starts the simulator with the sensor of a topic that nobody publishes, or ''."""
    if _has_simulator(graph):
        for end, option in _OFF_AT_FIRST.items():
            if topic.endswith(f'/{end}'):
                return _with_option(option)
    return ''


def _has_simulator(graph: Graph) -> bool:
    return any(node.name == _SIMULATOR for node in graph.nodes)


def _with_option(option: str) -> str:
    return (
        f'start the simulator with `--ros-args -p {option}`, or `{option}` behind its launch file'
    )


def _sensors_that_are_off(graph: Graph, waiting: _Uses) -> Iterator[Finding]:
    for each in waiting:
        if each.node.endswith(_VIEW):
            continue
        if remedy := how_to_switch_on(graph, each.name):
            yield Finding(
                each.name,
                f'{each.node} subscribes to this, but that sensor of the simulator is off',
                remedy,
            )
        elif each.type in _OFF_BY_TYPE and _has_simulator(graph):
            sensor, option = _OFF_BY_TYPE[each.type]
            yield Finding(
                each.name,
                f'{each.node} subscribes to this, {each.type}, which nobody publishes under any '
                f'name, because the {sensor} of the simulator is off',
                _with_option(option),
                serious=False,  # it may wait for something else
            )
