# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A participant of the domain, as far as it has announced itself."""

from __future__ import annotations

from dataclasses import dataclass, field

from rtps_graph import host, wire

# The topic in which every ROS process tells the nodes that it holds.
GRAPH_TOPIC = 'ros_discovery_info'
GRAPH_TYPE = 'rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_'
# As Jazzy's rmw_dds_common/msg/ParticipantEntitiesInfo.json has it; Cyclone DDS warns without it.
GRAPH_TYPE_HASH = 'RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e'


_MOST_ASKED = 256  # numbers in one ACKNACK (9.4.2.6)
_NEVER = 2**62  # no writer comes to that number, and one more can still be written


class Samples:
    """What has come from one reliable writer.

    What others say of it may be anything: of any range of numbers only the next few are kept.
    """

    def __init__(self) -> None:
        self.last: int | None = None  # unknown until its first heartbeat
        self.acknowledgements = 0
        self._next = 1  # all before it have come, or never will
        self._ahead: set[int] = set()

    def announce(self, first: int, last: int) -> None:
        """Take in what a heartbeat says: the numbers that the writer still has.

        :raises ValueError: they are none.
        """
        if not 0 <= last < _NEVER:
            raise ValueError(f'{last} is the number of no sample')
        self.last = last
        self.pass_over(1, first)

    def has(self, number: int) -> bool:
        return number < self._next or number in self._ahead

    def add(self, *numbers: int) -> None:
        self._ahead.update(numbers)
        self._advance()

    def pass_over(self, first: int, end: int) -> None:
        """Take in that numbers will never come; of those far ahead it is told again."""
        if first <= self._next:
            self._next = max(self._next, end)
        else:
            self._ahead.update(range(first, min(end, self._next + _MOST_ASKED)))
        self._advance()

    def _advance(self) -> None:
        while self._next in self._ahead:
            self._ahead.remove(self._next)
            self._next += 1

    @property
    def missing(self) -> set[int]:
        """Return the lowest numbers that have not come, as many as can be asked for at once."""
        end = min((self.last or 0) + 1, self._next + _MOST_ASKED)
        return {number for number in range(self._next, end) if number not in self._ahead}

    @property
    def complete(self) -> bool:
        return self.last is not None and self._next > self.last


@dataclass
class Participant:
    """A participant of the domain and what it announced."""

    prefix: bytes
    address: str
    discovery_port: int
    data_port: int
    foreign_memory: host.ForeignMemory | None = None
    publications: Samples = field(default_factory=Samples)
    subscriptions: Samples = field(default_factory=Samples)
    graph: Samples = field(default_factory=Samples)
    # Parameter lists of its endpoints by GUID, and the last sample of its graph topic.
    writers: dict[bytes, dict[int, list[bytes]]] = field(default_factory=dict)
    readers: dict[bytes, dict[int, list[bytes]]] = field(default_factory=dict)
    graph_sample: bytes | None = None
    knows_observer: bool = False

    def graph_writer(self) -> bytes | None:
        """Return the id of its writer of the graph topic; None: it is no ROS participant."""
        for guid, values in self.writers.items():
            topics = values.get(wire.PID_TOPIC_NAME, ())
            if any(topic.startswith(wire.string(GRAPH_TOPIC)) for topic in topics):
                return guid[12:]
        return None

    @property
    def complete(self) -> bool:
        if not (self.publications.complete and self.subscriptions.complete):
            return False
        return self.graph_sample is not None or self.graph_writer() is None
