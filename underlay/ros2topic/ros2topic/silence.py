# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why nothing arrives on a topic."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
import math
import sys
import threading
import time

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
    watched = _Publishers(node, topic)

    def has_arrived() -> bool:
        watched.look()
        return arrived()

    if node.spin_until(has_arrived, _SILENCE_SEC):
        return
    while True:
        if count := dropped():
            print(f'hint: {topic}: the filter let none of {count} messages pass', file=sys.stderr)
            return
        graph = _graph_read_meanwhile(node, watched.look)
        findings = why_silent(graph, topic, watched.silent_sec)
        if has_arrived():
            return
        for finding in findings:
            print(f'hint: {finding}', file=sys.stderr)
        # Otherwise a publisher has just begun, of which only time tells.
        if findings or node.spin_until(has_arrived, _SILENCE_SEC):
            return


class _Publishers:
    """For how long the publishers of a topic have been known to the node that listens."""

    def __init__(self, node: CommandNode, topic: str) -> None:
        self._node = node.node
        self._topic = topic
        self._since_sec: dict[bytes, float] = {}

    def look(self) -> None:
        """Look who is there; to be called again and again."""
        now_sec = time.monotonic()
        found = self._node.get_publishers_info_by_topic(self._topic)
        gids = [bytes(publisher.endpoint_gid) for publisher in found]
        self._since_sec = {gid: self._since_sec.get(gid, now_sec) for gid in gids}

    @property
    def silent_sec(self) -> float:
        """For how long nothing has come from the one that was found last."""
        return time.monotonic() - max(self._since_sec.values(), default=math.inf)


def _graph_read_meanwhile(node: CommandNode, look: Callable[[], None]) -> Graph:
    """Read the graph, while the node takes what comes: a rate of another topic would be wrong."""
    reading: Future[Graph] = Future()

    def read() -> None:
        try:
            reading.set_result(discovery.read_graph(quiet=True))
        except Exception as error:
            reading.set_exception(error)

    def is_read() -> bool:
        look()
        return reading.done()

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    try:
        node.spin_until(is_read)
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


def why_silent(graph: Graph, topic: str, silent_sec: float) -> list[Finding]:
    """
    Explain why a subscription of the topic gets nothing; [] where it may only be too early.

    :param silent_sec: how long its publishers are known to be silent.
    """
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
    if silent_sec < _SILENCE_SEC:
        return []
    names = sorted({graph.node_of(endpoint).full_name for endpoint in publishers})
    what = f'{", ".join(names)} has sent nothing for {_SILENCE_SEC:g} s'
    ours = [
        endpoint
        for endpoint in graph.with_role(Role.SUBSCRIPTION, topic)
        if nodes.shown_name(graph.node_of(endpoint)) == nodes.COMMAND
    ]
    kept = all(endpoint.qos.transient_local for endpoint in publishers)
    if kept and ours and not any(endpoint.qos.transient_local for endpoint in ours):
        return [
            Finding(
                topic,
                f'{what}, and what it sent before goes to who asks for TRANSIENT_LOCAL alone',
                f'`ros2 topic echo {topic} --qos-durability transient_local` does',
            )
        ]
    return [
        Finding(
            topic,
            what,
            'it may wait for something itself: look at its terminal, or run `ros2 doctor`',
        )
    ]
