# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The graph of a domain: its nodes, and the topics, services and actions that they have."""

from __future__ import annotations

from collections.abc import Iterable
import contextlib
from dataclasses import dataclass, field
import enum
import re
import struct

from rtps_graph import names, wire
from rtps_graph.host import ForeignMemory
from rtps_graph.participant import Participant

NODE_NAME_UNKNOWN = '_NODE_NAME_UNKNOWN_'
NODE_NAMESPACE_UNKNOWN = '_NODE_NAMESPACE_UNKNOWN_'
_FEEDBACK = '/_action/feedback'
_INFINITE_SEC = 0x7FFFFFFF
_UNKNOWN = '\N{REPLACEMENT CHARACTER}'


class Role(enum.Enum):
    PUBLISHER = 'PUBLISHER'
    SUBSCRIPTION = 'SUBSCRIPTION'
    SERVER = 'SERVER'
    CLIENT = 'CLIENT'


# By the prefix of the DDS topic, and whether the endpoint writes. A service is shown once: by the
# half that carries the requests.
_ROLES = {
    (names.TOPIC, True): Role.PUBLISHER,
    (names.TOPIC, False): Role.SUBSCRIPTION,
    (names.REQUEST, True): Role.CLIENT,
    (names.REQUEST, False): Role.SERVER,
}


@dataclass(frozen=True)
class Qos:
    """What discovery tells of an endpoint's quality of service; None stands for infinite."""

    reliable: bool
    transient_local: bool
    deadline_ns: int | None
    lifespan_ns: int | None
    manual_liveliness: bool
    liveliness_lease_ns: int | None


@dataclass(frozen=True)
class Endpoint:
    """A publisher, a subscription, or a half of a service server or client."""

    guid: bytes
    role: Role
    name: str  # of the topic or service
    type: str
    type_hash: str
    qos: Qos


@dataclass
class Node:
    name: str
    namespace: str
    endpoints: list[Endpoint] = field(default_factory=list)
    foreign_memory: ForeignMemory | None = None
    port: int | None = None  # at which its process listens for discovery

    @property
    def full_name(self) -> str:
        return names.full_node_name(self.namespace, self.name)

    @property
    def is_hidden(self) -> bool:
        return names.is_hidden(self.full_name)

    def having(self, role: Role) -> dict[str, list[str]]:
        """Map the names of its topics or services of this role to their types."""
        return types_by_name(e for e in self.endpoints if e.role is role)

    def action_servers(self) -> dict[str, list[str]]:
        return _actions(self.having(Role.PUBLISHER))

    def action_clients(self) -> dict[str, list[str]]:
        return _actions(self.having(Role.SUBSCRIPTION))


@dataclass
class Graph:
    """Everything that was announced in a domain at one moment."""

    nodes: list[Node]
    endpoints: list[Endpoint]
    silent_ports: tuple[int, ...] = ()  # of this host's participants that did not tell all
    silent_hosts: tuple[str, ...] = ()  # other ones with such a participant

    def topics(self) -> dict[str, list[str]]:
        return types_by_name(
            e for e in self.endpoints if e.role in (Role.PUBLISHER, Role.SUBSCRIPTION)
        )

    def services(self) -> dict[str, list[str]]:
        return types_by_name(e for e in self.endpoints if e.role in (Role.SERVER, Role.CLIENT))

    def actions(self) -> dict[str, list[str]]:
        return _actions(self.topics())

    def with_role(self, role: Role, name: str) -> list[Endpoint]:
        return [e for e in self.endpoints if e.role is role and e.name == name]

    def node_of(self, endpoint: Endpoint) -> Node:
        for node in self.nodes:
            if any(e.guid == endpoint.guid for e in node.endpoints):
                return node
        return Node(NODE_NAME_UNKNOWN, NODE_NAMESPACE_UNKNOWN)


def types_by_name(endpoints: Iterable[Endpoint]) -> dict[str, list[str]]:
    found: dict[str, set[str]] = {}
    for endpoint in endpoints:
        found.setdefault(endpoint.name, set()).add(endpoint.type)
    return {name: sorted(found[name]) for name in sorted(found)}


def _actions(topics: dict[str, list[str]]) -> dict[str, list[str]]:
    return {
        name.removesuffix(_FEEDBACK): [t.removesuffix('_FeedbackMessage') for t in types]
        for name, types in topics.items()
        if name.endswith(_FEEDBACK)
    }


def build(
    participants: Iterable[Participant],
    silent_ports: Iterable[int] = (),
    silent_hosts: Iterable[str] = (),
) -> Graph:
    """Put the graph together from what the participants announced."""
    graph = Graph([], [], tuple(sorted(silent_ports)), tuple(sorted(silent_hosts)))
    for participant in participants:
        endpoints = {
            guid: endpoint
            for found, written in ((participant.writers, True), (participant.readers, False))
            for guid, values in found.items()
            if (endpoint := _endpoint(guid, values, written)) is not None
        }
        graph.endpoints.extend(endpoints.values())
        for namespace, name, guids in _nodes(participant.graph_sample):
            known = [endpoints[guid] for guid in guids if guid in endpoints]
            graph.nodes.append(
                Node(
                    name,
                    namespace,
                    known,
                    participant.foreign_memory,
                    participant.discovery_port,
                )
            )
    graph.nodes.sort(key=lambda node: node.full_name)
    graph.endpoints.sort(key=lambda endpoint: endpoint.guid)
    return graph


def _endpoint(guid: bytes, values: dict[int, list[bytes]], written: bool) -> Endpoint | None:
    """Return an endpoint of ROS; None for another one, and for what is cut short."""
    with contextlib.suppress(struct.error):
        return _read_endpoint(guid, values, written)
    return None


def _read_endpoint(guid: bytes, values: dict[int, list[bytes]], written: bool) -> Endpoint | None:
    prefix, name = names.ros_topic(_string(values, wire.PID_TOPIC_NAME))
    role = _ROLES.get((prefix, written))
    if role is None:
        return None
    read_type = names.ros_type if prefix == names.TOPIC else names.service_type
    type_name = read_type(_string(values, wire.PID_TYPE_NAME))
    return Endpoint(guid, role, name, type_name, _type_hash(values), _qos(values, written))


def _string(values: dict[int, list[bytes]], pid: int) -> str:
    for value in values.get(pid, ()):
        (length,) = struct.unpack_from('<I', value)
        return _text(value[4 : 4 + length])
    return ''


def _text(data: bytes) -> str:
    """Read what is shown in a terminal, to which another program may want to tell more."""
    text = data.rstrip(b'\0').decode(errors='replace')
    return ''.join(letter if letter.isprintable() else _UNKNOWN for letter in text)


def _type_hash(values: dict[int, list[bytes]]) -> str:
    (user_data, *_) = values.get(wire.PID_USER_DATA, [b''])
    match = re.search(rb'(?:^|;)typehash=([^;]*)', user_data[4:].rstrip(b'\0'))
    return _text(match[1]) if match else 'INVALID'


def _qos(values: dict[int, list[bytes]], written: bool) -> Qos:
    def number(pid: int, default: int) -> int:
        for value in values.get(pid, ()):
            return int(struct.unpack_from('<I', value)[0])
        return default

    def duration_ns(pid: int, at: int = 0) -> int | None:
        for value in values.get(pid, ()):
            sec, fraction = struct.unpack_from('<iI', value, at)
            return None if sec == _INFINITE_SEC else sec * 10**9 + (fraction * 10**9 >> 32)
        return None

    return Qos(
        # Where it is not told, a writer is reliable and a reader is not (DDS 1.4, 2.2.3.14).
        reliable=number(wire.PID_RELIABILITY, 2 if written else 1) == 2,
        transient_local=number(wire.PID_DURABILITY, 0) >= 1,
        deadline_ns=duration_ns(wire.PID_DEADLINE),
        lifespan_ns=duration_ns(wire.PID_LIFESPAN),
        manual_liveliness=number(wire.PID_LIVELINESS, 0) == 2,
        liveliness_lease_ns=duration_ns(wire.PID_LIVELINESS, 4),
    )


def _nodes(sample: bytes | None) -> list[tuple[str, str, list[bytes]]]:
    """Return namespace, name and GUIDs of each node; none where the sample is cut short."""
    if sample is not None:
        with contextlib.suppress(IndexError, struct.error):
            return _read_nodes(sample)
    return []


def _read_nodes(sample: bytes) -> list[tuple[str, str, list[bytes]]]:
    """Read rmw_dds_common/msg/ParticipantEntitiesInfo."""
    body, at = sample[4:], 16  # behind the encapsulation header: the participant's own GID
    order = '<' if sample[1] & 1 else '>'

    def count() -> int:
        nonlocal at
        at += -at % 4
        at += 4
        return int(struct.unpack_from(order + 'I', body, at - 4)[0])

    def text() -> str:
        nonlocal at
        length = count()
        at += length
        return _text(body[at - length : at])

    found = []
    for _ in range(count()):
        namespace, name = text(), text()
        guids: list[bytes] = []
        for _ in ('readers', 'writers'):
            length = count()
            end = at + 16 * length
            guids.extend(body[begin : begin + 16] for begin in range(at, min(end, len(body)), 16))
            at = end
        found.append((namespace, name, guids))
    return found
