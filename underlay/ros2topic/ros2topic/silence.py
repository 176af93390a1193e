# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why nothing arrives on a topic."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
import sys
import threading

from ros2_diagnosis import connections, nodes, partners
from ros2_diagnosis.finding import Finding
from ros2cli import discovery
from ros2cli.node.direct import CommandNode
from rtps_graph.graph import Graph, Role

_SILENCE_SEC = 2.0
_FAREWELL_SEC = 1.0  # so long an interrupt lets a reading end and say that it is over


def hint_when_silent(
    node: CommandNode,
    topic: str,
    arrived: Callable[[], bool],
    dropped: Callable[[], int] = lambda: 0,
) -> None:
    """Spin until something has arrived; print why not where that takes long.

    :param dropped: tells how many messages a filter has kept from arriving.
    """
    if node.spin_until(arrived, _SILENCE_SEC):
        return
    if count := dropped():
        print(f'hint: {topic}: the filter let none of {count} messages pass', file=sys.stderr)
        return
    graph = _graph_read_meanwhile(node)
    for finding in () if arrived() else why_silent(graph, topic):
        print(f'hint: {finding}', file=sys.stderr)


def _graph_read_meanwhile(node: CommandNode) -> Graph:
    """Read the graph, while the node takes what comes: a rate of another topic would be wrong."""
    reading: Future[Graph] = Future()

    def read() -> None:
        try:
            reading.set_result(discovery.read_graph(quiet=True))
        except Exception as error:
            reading.set_exception(error)

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    try:
        node.spin_until(reading.done)
    finally:
        thread.join(_FAREWELL_SEC)
    return reading.result()


def hint_when_not_received(topic: str) -> None:
    """Print why a subscription does not get what this command publishes, or what was meant."""
    graph = discovery.read_graph(quiet=True)
    hearers = map(graph.node_of, graph.with_role(Role.SUBSCRIPTION, topic))
    for finding in (*nodes.check_memory(hearers), *connections.check(graph, topic)):
        print(f'hint: {finding}', file=sys.stderr)
    heard = {endpoint.name for endpoint in graph.endpoints if endpoint.role is Role.SUBSCRIPTION}
    if topic not in heard:
        discovery.hint_near(f"nobody subscribes to '{topic}'", topic, heard)


def why_silent(graph: Graph, topic: str) -> list[Finding]:
    """Explain why a subscription of the topic gets nothing."""
    publishers = graph.with_role(Role.PUBLISHER, topic)
    if not publishers:
        nobody = Finding(
            topic,
            'nobody publishes it',
            'start the node that does; `ros2 topic list` shows what there is',
        )
        apart = partners.check_topics(graph)
        return [each for each in apart if topic in each.where.split(', ')] or [nobody]
    if found := [
        *nodes.check_memory(map(graph.node_of, publishers)),
        *connections.check(graph, topic),
        *nodes.check_clock(graph),
    ]:
        return found
    names = sorted({graph.node_of(endpoint).full_name for endpoint in publishers})
    return [
        Finding(
            topic,
            f'{", ".join(names)} has sent nothing for {_SILENCE_SEC:g} s',
            'it may wait for something itself: look at its terminal, or run `ros2 doctor`',
        )
    ]
