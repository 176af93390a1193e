# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Simulation time that stands still, because its simulation is paused or waits."""

from __future__ import annotations

from collections.abc import Iterator

from rclpy.qos import qos_profile_sensor_data
from ros2_diagnosis import nodes
from ros2_diagnosis.finding import Finding
from ros2cli import interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node, CommandNode
from ros2param import api
from rtps_graph.graph import Graph, Node, Role

_CLOCK = '/clock'
# What lets a simulator of ours go on, and a player of bags.
_GO_ON = {
    'pause': 'std_srvs/srv/SetBool "{data: false}"',
    'resume': 'rosbag2_interfaces/srv/Resume',
}
_LISTEN_SEC = 2.5  # at a hundredth of real time 50 Hz come every 2 s


def check_clock_runs(graph: Graph) -> Iterator[Finding]:
    """Listen to the clock, where there is one that can be heard here."""
    publishers = [graph.node_of(each) for each in graph.with_role(Role.PUBLISHER, _CLOCK)]
    if not publishers or any(nodes.check_memory(publishers)):
        return
    with command_node() as node:
        if _passes(node):
            return
        shown = ', '.join(sorted({nodes.shown_name(each) for each in publishers}))
        why, mend = _why(node, publishers[0])
        yield Finding(
            _CLOCK,
            f'stands still: {shown} {why}, so that timers and sleeps in simulation time wait',
            mend,
        )


def _passes(node: CommandNode) -> bool:
    """Tell whether two different times come."""
    heard: set[bytes] = set()
    node.node.create_subscription(
        interfaces.message('rosgraph_msgs/msg/Clock'),
        _CLOCK,
        lambda message: heard.add(message),  # rclpy asks it for its signature
        qos_profile_sensor_data,
        raw=True,
    )
    first_comes = node.spin_until(lambda: len(heard) > 0, _LISTEN_SEC)
    return first_comes and node.spin_until(lambda: len(heard) > 1, _LISTEN_SEC)


def _why(node: CommandNode, publisher: Node) -> tuple[str, str]:
    """Return what the publisher of the clock may wait for, and what lets it go on."""
    if _is_in_lockstep(node, publisher):
        return (
            'waits for the answer to its odometry, because its parameter `lockstep` is true',
            'start a driver, or the simulator without `lockstep:=true`',
        )
    offered = publisher.having(Role.SERVER)
    for service, request in _GO_ON.items():
        name = f'{publisher.full_name}/{service}'
        if offered.get(name) == [request.partition(' ')[0]]:
            return 'is paused', f'`ros2 service call {name} {request}` lets it go on'
    return 'tells no new time', 'let it go on, or end it'


def _is_in_lockstep(node: CommandNode, publisher: Node) -> bool:
    try:
        (value,) = api.call_get_parameters(
            node=node, node_name=publisher.full_name, parameter_names=['lockstep']
        ).values
    except CommandError:  # it does not answer
        return False
    return bool(api.get_value(parameter_value=value))
