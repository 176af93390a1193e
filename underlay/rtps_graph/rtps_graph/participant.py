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


@dataclass
class Samples:
    """What has come from one reliable writer."""

    first: int = 1
    last: int | None = None  # unknown until its first heartbeat
    received: set[int] = field(default_factory=set)
    acknowledgements: int = 0

    @property
    def missing(self) -> set[int]:
        return set(range(self.first, (self.last or 0) + 1)) - self.received

    @property
    def complete(self) -> bool:
        return self.last is not None and not self.missing


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
