# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Other publishers of topics that must have one: commands of two drivers, a second odometry or clock.

ROS 2 allows it, and a run that was disturbed so is not valid.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rclpy.clock import Clock, ClockType
from rclpy.node import Node

CHECK_SEC = 0.1
"""Wall time between two checks of the graph."""

NAME_CHECKS = 20
"""How many checks to wait for the name of a node, which has a message of its own."""

UNSEEN_CHECKS = 2
"""How many checks the graph may lack a publisher: Cyclone DDS tells a reader of it first."""

GONE = 'a node that is gone already'

UNKNOWN_NAME = '_NODE_NAME_UNKNOWN_'
"""What rmw_dds_common calls a node until that message is there."""

_PARTICIPANT = 12
"""Bytes of an endpoint's GUID that name its participant (OMG DDSI-RTPS 2.2, 9.3.1)."""


@dataclass(frozen=True)
class Interference:
    """More nodes than one publish a topic, or topics that command one robot."""

    topics: tuple[str, ...]
    nodes: tuple[str, ...]  # full names; of two with one name, that name twice
    ours: bool  # whether the simulator alone should publish it

    @property
    def where(self) -> str:
        return ' and '.join(self.topics)

    def __str__(self) -> str:
        names = ' and '.join(self.nodes)
        many = len(self.nodes) > 1
        if self.ours:
            what = f'{names} also publish{"" if many else "es"} {self.where}, which the simulator'
            return f'{what} publishes: end what is not of this run, or use another ROS_DOMAIN_ID'
        return (
            f'{names} all publish {self.where}: the robot gets a mixture of their commands; '
            'end all but one, or use another ROS_DOMAIN_ID'
        )


class InterferenceWatch:
    """
    Finds other publishers.

    :param ours: topics that this node alone should publish.
    :param commands: for each robot, the topics that one node should publish.
    :param on_found: called once for each topic and set of nodes, and again after a restart.
    """

    def __init__(
        self,
        node: Node,
        *,
        ours: Sequence[str],
        commands: Sequence[Sequence[str]],
        on_found: Callable[[Interference], None],
    ) -> None:
        self._node = node
        self._topics = [
            *(((topic,), True) for topic in ours),
            *((tuple(topics), False) for topics in commands),
        ]
        self._on_found = on_found
        self._found: set[Interference] = set()
        self._nameless_checks = 0
        self._unseen: dict[str, tuple[int, int]] = {}  # by topic: publishers, checks left
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(CHECK_SEC, self._on_timer, clock=steady)

    def check(self, *, at_the_end: bool = False) -> None:
        """
        Check now.

        :param at_the_end: do not wait for names.
        """
        for topics, ours in self._topics:
            counts = {topic: self._node.count_publishers(topic) for topic in topics}
            if sum(counts.values()) < 2:
                continue
            spoken = tuple(topic for topic, count in counts.items() if count)
            others = _publishers(self._node, spoken)
            nameless = any(UNKNOWN_NAME in name for name in others)
            if nameless and self._nameless_checks < NAME_CHECKS and not at_the_end:
                self._nameless_checks += 1
                continue
            me = self._node.get_fully_qualified_name()
            if ours and me in others:
                others.remove(me)
            if len(others) > (not ours):
                self._report(Interference(spoken, tuple(others), ours))
        if at_the_end:
            for topic in [*self._unseen]:
                self._end_search(topic)

    def restart(self) -> None:
        """Report also what was found before: another run begins, and it may disturb that too."""
        self._found.clear()
        self.check()

    def check_commands(self, topic: str, publishers: int) -> None:
        """Check a topic of commands when DDS reports so many publishers at once."""
        self.check()
        if publishers > 1 and self._node.count_publishers(topic) < publishers:
            self._unseen[topic] = publishers, UNSEEN_CHECKS

    def _on_timer(self) -> None:
        self.check()
        for topic, (publishers, left) in [*self._unseen.items()]:
            self._unseen[topic] = publishers, left - 1
            if left == 1:
                self._end_search(topic)

    def _end_search(self, topic: str) -> None:
        """Report a publisher that the graph has not shown."""
        publishers, _ = self._unseen.pop(topic)
        known = any(topic in found.topics for found in self._found)
        if not known and self._node.count_publishers(topic) < publishers:
            there = _publishers(self._node, (topic,))
            self._report(Interference((topic,), (*there, GONE), ours=False))

    def _report(self, found: Interference) -> None:
        if found not in self._found:
            self._found.add(found)
            self._on_found(found)


def _publishers(node: Node, topics: Sequence[str]) -> list[str]:
    """Return the full name of every node that publishes one of the topics, once for each."""
    seen: dict[tuple[bytes, str], str] = {}
    for topic in topics:
        for info in node.get_publishers_info_by_topic(topic):
            name = f'{info.node_namespace.rstrip("/")}/{info.node_name}'
            seen[bytes(info.endpoint_gid[:_PARTICIPANT]), name] = name
    return sorted(seen.values())
