# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that a publisher keeps for who comes late, and that who came late has not asked for."""

from __future__ import annotations

from collections.abc import Iterator
import os
from pathlib import Path
import time
from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile
from ros2_diagnosis import nodes
from ros2_diagnosis.finding import Finding
from ros2cli import interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node, CommandNode
from rtps_graph import host, names
from rtps_graph.graph import Graph, Node, Role

_KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_FIRST_SEC, _LISTEN_SEC = 5.0, 1.0  # DDS repeats after 3 s what got lost of a new subscription
_LOG = '/rosout'  # of which nobody misses what was said before
_BEGIN = 19  # in ticks since the machine started: `starttime` of proc(5), counted from the state


def check_kept(graph: Graph) -> Iterator[Finding]:
    """Find nodes that began after the newest message was sent, and did not ask for it."""
    late = {topic: readers for topic in graph.topics() if (readers := _volatile(graph, topic))}
    if not late:
        return
    with command_node() as node:
        sent = _newest(node, {topic: graph.topics()[topic][0] for topic in late})
    for topic, sent_sec in sorted(sent.items()):
        for reader in late[topic]:
            begin_sec = _begin(reader)
            if begin_sec is not None and sent_sec < begin_sec:
                yield Finding(
                    topic,
                    f'{reader.full_name} began {begin_sec - sent_sec:.1f} s after the newest '
                    'message was sent, which is kept for who asks for TRANSIENT_LOCAL, so that '
                    'it has not got it',
                    'subscribe with `QoSProfile(depth=1, durability=DurabilityPolicy.'
                    'TRANSIENT_LOCAL)`',
                    serious=False,
                )


def _volatile(graph: Graph, topic: str) -> list[Node]:
    """Return who reads a topic whose publishers all keep messages, and does not ask for these."""
    publishers = graph.with_role(Role.PUBLISHER, topic)
    keep = all(each.qos.transient_local for each in publishers)
    one_type = len(graph.topics()[topic]) == 1
    if not publishers or not keep or not one_type or topic == _LOG or names.is_hidden(topic):
        return []
    if any(nodes.check_memory(map(graph.node_of, publishers))):
        return []
    asked = [e for e in graph.with_role(Role.SUBSCRIPTION, topic) if e.qos.transient_local]
    asking = {id(graph.node_of(each)) for each in asked}
    found = {
        id(node): node
        for node in map(graph.node_of, graph.with_role(Role.SUBSCRIPTION, topic))
        if not node.is_hidden
    }
    return [node for each, node in found.items() if each not in asking]


def _newest(node: CommandNode, types: dict[str, str]) -> dict[str, float]:
    """Map topics to when the newest of their messages was sent, as far as there is one."""
    sent: dict[str, float] = {}
    awaited: set[str] = set()

    def listen(topic: str, kind: Any) -> None:
        def on_message(_: Any, info: Any) -> None:
            sent[topic] = max(sent.get(topic, 0.0), info['source_timestamp'] * 1e-9)

        node.node.create_subscription(kind, topic, on_message, _KEPT, raw=True)

    for topic, type_name in types.items():
        try:
            listen(topic, interfaces.message(type_name))
        except CommandError:
            continue  # of a workspace that is not sourced here
        awaited.add(topic)
    if node.spin_until(lambda: awaited <= sent.keys(), _FIRST_SEC):
        node.spin_until(lambda: False, _LISTEN_SEC)  # there may be newer ones
    return sent


def _begin(node: Node) -> float | None:
    """Return when the process of a node began, by the clock of the wall; None where not known."""
    process = host.process_at(node.port) if node.port is not None else None
    if process is None:
        return None
    try:
        words = (process / 'stat').read_text(errors='replace').rpartition(')')[2].split()
        up_sec = float(Path('/proc/uptime').read_text().split()[0])
    except OSError:  # it has ended
        return None
    began_sec = int(words[_BEGIN]) / os.sysconf('SC_CLK_TCK')
    return time.time() - (up_sec - began_sec)
