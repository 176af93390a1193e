# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Velocity commands that come too rarely for the robot that they drive."""

from __future__ import annotations

from collections.abc import Iterator
import itertools
import time
from typing import Any

from rclpy.qos import qos_profile_sensor_data
from ros2_diagnosis.finding import Finding
from ros2cli import interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node, CommandNode
from ros2param import api, params
from rtps_graph.graph import Graph, Node, Role

_TOPIC_END = 'cmd_vel'
_TIMEOUT_PARAMETERS = ('command_timeout', 'command_timeout_sec', 'cmd_vel_timeout')
_LISTEN_SEC = 1.5


def check_command_rate(graph: Graph) -> Iterator[Finding]:
    """Measure the commands of each robot that tells its timeout as a parameter."""
    watched = [
        (name, receiver)
        for name in graph.topics()
        if name.endswith(_TOPIC_END) and graph.with_role(Role.PUBLISHER, name)
        for receiver in _receivers(graph, name)
    ]
    if not watched:
        return
    with command_node() as node:
        for name, receiver in watched:
            timeout_sec = _timeout(node, receiver)
            if timeout_sec is None:
                continue
            longest, speed = _longest_gap(node, graph, name)
            if longest is not None and longest * speed > timeout_sec:
                yield Finding(
                    name,
                    f'commands come up to {longest * speed:.2f} s apart, but {receiver.full_name} '
                    f'stops the robot {timeout_sec:g} s after the last one, so that it jerks',
                    f'publish at least {1.5 / timeout_sec:.0f} times a second '
                    f'(`ros2 topic pub -r {2 / timeout_sec:.0f} {name} ...`)',
                )


def _receivers(graph: Graph, topic: str) -> list[Node]:
    found = (graph.node_of(e) for e in graph.with_role(Role.SUBSCRIPTION, topic))
    return [node for node in found if params.has_parameters(node)]


def _timeout(node: CommandNode, receiver: Node) -> float | None:
    """Ask a node for its command timeout; None where it has none, or does not depend on it."""
    try:
        known = api.list_names(node=node, node_name=receiver.full_name)
        wanted = [name for name in known if name.rpartition('.')[2] in _TIMEOUT_PARAMETERS]
        wanted += [name for name in known if name == 'lockstep']
        values = api.call_get_parameters(
            node=node, node_name=receiver.full_name, parameter_names=wanted
        ).values
    except CommandError:
        return None
    plain = (api.get_value(parameter_value=value) for value in values)
    found = dict(zip(wanted, plain, strict=True))
    if found.pop('lockstep', False):
        return None  # The simulation waits for each command.
    timeouts = [value for value in found.values() if isinstance(value, (int, float)) and value > 0]
    return float(timeouts[0]) if timeouts else None


def _longest_gap(node: CommandNode, graph: Graph, topic: str) -> tuple[float | None, float]:
    """Return the longest time between two commands, and how fast simulation time passes."""
    arrivals: list[float] = []
    clock: list[tuple[float, float]] = []
    (type_name, *_) = graph.topics()[topic]
    subscriptions = [
        node.node.create_subscription(
            interfaces.message(type_name),
            topic,
            lambda _: arrivals.append(time.monotonic()),
            qos_profile_sensor_data,
            raw=True,
        )
    ]
    if graph.with_role(Role.PUBLISHER, '/clock'):

        def on_clock(msg: Any) -> None:
            clock.append((time.monotonic(), msg.clock.sec + msg.clock.nanosec * 1e-9))

        subscriptions.append(
            node.node.create_subscription(
                interfaces.message('rosgraph_msgs/msg/Clock'),
                '/clock',
                on_clock,
                qos_profile_sensor_data,
            )
        )
    if node.spin_until(lambda: len(arrivals) > 0, _LISTEN_SEC):
        node.spin_until(lambda: False, _LISTEN_SEC)
    for subscription in subscriptions:
        node.node.destroy_subscription(subscription)
    gaps = [b - a for a, b in itertools.pairwise(arrivals)]
    speed = 1.0
    if len(clock) > 1 and clock[-1][0] > clock[0][0]:
        speed = (clock[-1][1] - clock[0][1]) / (clock[-1][0] - clock[0][0])
    return (max(gaps) if gaps else None), speed
