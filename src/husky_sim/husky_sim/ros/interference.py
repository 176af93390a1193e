# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Other publishers of topics that must have one: commands of two drivers, a second odometry or clock.

ROS 2 allows it, and a run that was disturbed so is not valid.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
import time

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.topic_endpoint_info import TopicEndpointInfo

CHECK_SEC = 0.1
"""Wall time between two checks of the graph."""

NAME_CHECKS = 20
"""How many checks to wait for the name of a node, which has a message of its own."""

UNSEEN_CHECKS = 2
"""How many checks the graph may lack a publisher: Cyclone DDS tells a reader of it first."""

LATELY_SEC = 1.0
"""Wall time, in which the graph and DDS may tell of the same publishers."""

GONE = 'a node that is gone already'

UNKNOWN_NAME = '_NODE_NAME_UNKNOWN_'
"""What rmw_dds_common calls a node until that message is there."""

_PARTICIPANT = 12
"""Bytes of an endpoint's GUID that name its participant (OMG DDSI-RTPS 2.2, 9.3.1)."""


@dataclass(frozen=True)
class Interference:
    """More than one publish a topic, or topics that command one robot."""

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
    :param commands: for each robot, the topics that one program should publish.
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
        # By topic: the publishers of one program that the graph has shown lately, and when.
        self._shown: dict[str, dict[bytes, float]] = {t: {} for topics in commands for t in topics}
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
            if not ours:
                self._note_programs(topics)
            spoken = tuple(topic for topic, count in counts.items() if count)
            others = _publishers(self._node, spoken, each_node=ours)
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
        if publishers > 1 and self._count_lately(topic) < publishers:
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
        if not known and self._count_lately(topic) < publishers:
            there = _publishers(self._node, (topic,), each_node=False)
            self._report(Interference((topic,), (*there, GONE), ours=False))

    def _note_programs(self, topics: Sequence[str]) -> None:
        """Note the publishers of commands, where all are of one program: they may go at once."""
        now_sec = time.monotonic()
        infos = [(t, info) for t in topics for info in self._node.get_publishers_info_by_topic(t)]
        if len({_participant(info) for _, info in infos}) == 1:
            for topic, info in infos:
                self._shown[topic][bytes(info.endpoint_gid)] = now_sec

    def _count_lately(self, topic: str) -> int:
        """Return how many publishers there are, or were lately of one program alone."""
        since_sec = time.monotonic() - LATELY_SEC
        shown = {gid: at_sec for gid, at_sec in self._shown[topic].items() if at_sec > since_sec}
        self._shown[topic] = shown
        return max(self._node.count_publishers(topic), len(shown))

    def _report(self, found: Interference) -> None:
        if found not in self._found:
            self._found.add(found)
            self._on_found(found)


def _participant(info: TopicEndpointInfo) -> bytes:
    """Return what all endpoints of one program have in common."""
    return bytes(info.endpoint_gid[:_PARTICIPANT])


def _publishers(node: Node, topics: Sequence[str], *, each_node: bool) -> list[str]:
    """
    Return the full name of every node that publishes one of the topics, once for each.

    :param each_node: else of the nodes of one program, which has one participant, there is one: a
        program may have a node that only stops, or make a publisher anew for each command.
    """
    seen: dict[tuple[bytes, str], str] = {}
    for topic in topics:
        for info in node.get_publishers_info_by_topic(topic):
            name = f'{info.node_namespace.rstrip("/")}/{info.node_name}'
            whose = _participant(info), name if each_node else ''
            seen[whose] = min(seen.get(whose, name), name, key=_known_first)
    return sorted(seen.values())


def _known_first(name: str) -> tuple[bool, str]:
    return UNKNOWN_NAME in name, name
