# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read the discovery data of a ROS domain, completely and at once.

A participant of Fast DDS needs 0.2 s to 3 s to know the others: it announces itself before it
listens, so that answers are lost and come again only with the next periodic announcement. The
observer here listens first, knows from the kernel how many participants there are, and asks
again after milliseconds. It joins the domain as a participant that has one reader, the one of
`ros_discovery_info`, in which every ROS process tells the nodes that it holds.
"""

from __future__ import annotations

from collections.abc import Callable
import contextlib
import os
import select
import socket
import struct
import time

from rtps_graph import announcements, host, wire
from rtps_graph.participant import Participant, Samples

_RETRY_SEC = 0.03  # doubled each time: on a busy machine answers come late
_RETRY_MOST_SEC = 0.24
_UNREAD_SEC = 1.0  # so long, at most, what has come is read before more is asked for
_LAST_PORT = 65535
_LOOK_SEC = 0.5  # so long a participant may be silent before its process is looked at
# The readers of the built-in writers; every other writer is that of the graph topic.
_READERS = {
    wire.PUBLICATIONS_WRITER: wire.PUBLICATIONS_READER,
    wire.SUBSCRIPTIONS_WRITER: wire.SUBSCRIPTIONS_READER,
}


class Observer:
    """One reading of a domain; close it, or use it as a context manager.

    :param subnet: ask other hosts too, by multicast; they cannot be counted, so that a reading
        then also waits for a while without news.
    """

    def __init__(
        self, *, domain_id: int, subnet: bool = False, static_peers: tuple[str, ...] = ()
    ) -> None:
        self.domain_id = domain_id
        self.participants: dict[bytes, Participant] = {}
        # Ports of this host's participants that kept silent, or have not told all that they have.
        self.unanswered: set[int] = set()
        self.silent_hosts: set[str] = set()  # other ones, of which somebody has not told all
        self._stopped: set[int] = set()  # those of them whose process is stopped
        self._subnet = subnet
        self._static_peers = static_peers
        self._addresses = _own_addresses(remote=subnet or bool(static_peers))
        self._bound: set[int] = set()  # the UDP ports of this host, at the last look
        self._prefix = bytes((0, 0)) + os.urandom(10)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        self._socket.bind(('0.0.0.0' if subnet or static_peers else '127.0.0.1', 0))
        self._news_sec = 0.0
        self._unread = select.poll()  # select.select fails where a process has 1024 files open
        self._unread.register(self._socket, select.POLLIN)
        self._due: dict[tuple[bytes, bytes], None] = {}  # participants and writers to answer

    def __enter__(self) -> Observer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        if self._socket.fileno() < 0:
            return
        removal = announcements.removal(self._prefix)
        for participant in self.participants.values():
            self._send(removal, participant.address, participant.discovery_port)
        self._socket.close()

    def observe(
        self,
        *,
        timeout_sec: float,
        settle_sec: float = 0.3,
        check: Callable[[], None] = lambda: None,
    ) -> bool:
        """Read until everything is known; False where something that is there is not.

        That is so where `timeout_sec` passed before, or where a process is stopped.

        :param settle_sec: how long nothing new may come before other hosts count as complete.
        :param check: called every 0.03 s or sooner; what it raises ends the reading.
        """
        start = self._news_sec = asked = time.monotonic()
        retry, wait_sec, look = start, _RETRY_SEC, start + _LOOK_SEC
        expected: set[int] | None = None
        while (now := time.monotonic()) < start + timeout_sec:
            check()
            # On a busy machine this process runs seldom. What it asks for that lies unread is sent
            # again, and soon more comes than is read.
            if not self._unread.poll(0) or now >= asked + _UNREAD_SEC:
                asked = now
                self._acknowledge_due()
                if now >= retry:
                    expected = self._count()
                    self._ask_again(expected)
                    retry, wait_sec = now + wait_sec, min(2 * wait_sec, _RETRY_MOST_SEC)
            if self.unanswered and now >= look:
                self._stopped = host.stopped_ports(self.unanswered)
                look = now + _LOOK_SEC
            counted = expected is not None and not self._subnet and not self._static_peers
            if self._is_complete(expected) and (counted or now - self._news_sec >= settle_sec):
                return not self.unanswered
            self._receive(min(retry - time.monotonic(), _RETRY_SEC))
        return False

    def _acknowledge_due(self) -> None:
        for prefix, writer in self._due:
            if (participant := self.participants.get(prefix)) is not None:
                self._acknowledge(participant, writer)
        self._due.clear()

    def _is_complete(self, expected: set[int] | None) -> bool:
        answered = {p.discovery_port for p in self.participants.values()}
        unfinished = [p for p in self.participants.values() if not p.complete]
        here = {p.discovery_port for p in unfinished if p.address in self._addresses}
        self.unanswered = (expected or set()) - answered | here
        self.silent_hosts = {p.address for p in unfinished if p.address not in self._addresses}
        return not self.silent_hosts and self.unanswered <= self._stopped

    def _count(self) -> set[int] | None:
        """Return the discovery ports of this host's participants; None if it cannot be known.

        A participant whose port is no longer bound was killed, without a farewell: it is left out.
        """
        bound = host.bound_udp_ports()
        if bound is None:
            return None
        closed, self._bound = self._bound - bound, bound
        for participant in [*self.participants.values()]:
            if participant.address in self._addresses and participant.discovery_port in closed:
                del self.participants[participant.prefix]
        return host.participant_ports(self.domain_id, bound)

    # Asking

    def _ask_again(self, expected: set[int] | None) -> None:
        announcement = announcements.participant(
            self._prefix, self._addresses, self._socket.getsockname()[1]
        )
        answered = {p.discovery_port for p in self.participants.values()}
        ports = host.discovery_ports(self.domain_id) if expected is None else expected
        for port in set(ports) - answered:
            self._send(announcement, '127.0.0.1', port)
        for peer in self._static_peers:
            for port in host.discovery_ports(self.domain_id)[:32]:
                self._send(announcement, peer, port)
        if self._subnet:
            port = host.multicast_port(self.domain_id)
            self._send(announcement, host.MULTICAST_ADDRESS, port)
        for participant in self.participants.values():
            if not participant.complete:
                self._ask_participant(participant)

    def _ask_participant(self, participant: Participant) -> None:
        for writer in _READERS:
            self._acknowledge(participant, writer)
        if not participant.knows_observer:
            self._offer_graph_reader(participant)
        graph_writer = participant.graph_writer()
        if graph_writer is not None and participant.graph_sample is None:
            self._acknowledge(participant, graph_writer)

    def _acknowledge(self, participant: Participant, writer: bytes) -> None:
        samples = self._samples(participant, writer)
        missing = samples.missing if samples.last is not None else {1}
        base = min(missing) if missing else (samples.last or 0) + 1
        samples.acknowledgements += 1
        message = wire.header(self._prefix) + wire.info_destination(participant.prefix)
        message += wire.acknack(
            _READERS.get(writer, announcements.GRAPH_READER),
            writer,
            base=base,
            missing=missing,
            count=samples.acknowledgements,
        )
        graph = samples is participant.graph
        port = participant.data_port if graph else participant.discovery_port
        self._send(message, participant.address, port)

    def _offer_graph_reader(self, participant: Participant) -> None:
        participant.graph.acknowledgements += 1
        message = announcements.graph_reader(
            self._prefix, participant.prefix, participant.graph.acknowledgements
        )
        self._send(message, participant.address, participant.discovery_port)

    def _send(self, message: bytes, address: str, port: int) -> None:
        # Asked again in a moment; and a host that cannot be reached has no nodes to show.
        with contextlib.suppress(OSError):
            self._socket.sendto(message, (address, port))

    # Reading

    def _receive(self, timeout_sec: float) -> None:
        self._socket.settimeout(max(timeout_sec, 0.001))
        try:
            datagram, (address, _) = self._socket.recvfrom(65536)
        except OSError:
            return
        for message in wire.parse(datagram, own_prefix=self._prefix):
            try:
                self._on_submessage(message, address)
            except (ValueError, struct.error):
                continue  # A sample of something that is not ROS; the rest still counts.

    def _on_submessage(self, message: wire.Submessage, address: str) -> None:
        if message.kind == wire.DATA and message.writer_id == wire.SPDP_WRITER:
            self._on_participant(message, address)
            return
        participant = self.participants.get(message.source)
        if participant is None:
            return
        if message.kind == wire.ACKNACK:
            if message.writer_id == wire.SUBSCRIPTIONS_WRITER and message.first > 1:
                participant.knows_observer = True
            return
        samples = self._samples(participant, message.writer_id)
        if message.kind == wire.HEARTBEAT:
            samples.announce(message.first, message.last)
            if message.writer_id in _READERS or (
                message.writer_id == participant.graph_writer()
                and message.reader_id != wire.UNKNOWN_ENTITY
            ):
                self._due[participant.prefix, message.writer_id] = None
        elif message.kind == wire.GAP:
            samples.pass_over(message.first, message.last)
            samples.add(*message.irrelevant)
        elif message.kind == wire.DATA and not samples.has(message.first):
            samples.add(message.first)
            self._news_sec = time.monotonic()
            self._on_sample(participant, message)

    def _on_participant(self, message: wire.Submessage, address: str) -> None:
        if message.disposed:
            self.participants.pop(message.source, None)
            return
        if message.source in self.participants or message.source == self._prefix:
            return
        values = wire.parameters(message.payload)
        locators = values.get(wire.PID_DEFAULT_UNICAST_LOCATOR, [])
        discovery = _port(
            wire.LOCATOR_UDP_V4, values.get(wire.PID_METATRAFFIC_UNICAST_LOCATOR, [])
        )
        data = _port(wire.LOCATOR_UDP_V4, locators)
        if discovery is None or data is None:
            return
        participant = Participant(message.source, address, discovery, data)
        memory = _port(wire.LOCATOR_SHARED_MEMORY, locators)
        # In other ranges the nodes of this terminal have no shared memory (config/fastdds.xml).
        if memory is not None and not self._subnet and address in self._addresses:
            participant.foreign_memory = host.foreign_memory(memory)
        self.participants[message.source] = participant
        self._news_sec = time.monotonic()
        self._ask_participant(participant)

    def _on_sample(self, participant: Participant, message: wire.Submessage) -> None:
        if message.writer_id in (wire.PUBLICATIONS_WRITER, wire.SUBSCRIPTIONS_WRITER):
            published = message.writer_id == wire.PUBLICATIONS_WRITER
            endpoints = participant.writers if published else participant.readers
            values = wire.parameters(message.payload)
            (guid, *_) = (
                values.get(wire.PID_ENDPOINT_GUID) or values.get(wire.PID_KEY_HASH) or [b'']
            )
            if message.disposed:
                endpoints.pop(guid, None)
            elif guid:
                endpoints[guid] = values
        elif message.payload and not message.disposed:
            participant.graph_sample = message.payload

    def _samples(self, participant: Participant, writer_id: bytes) -> Samples:
        if writer_id == wire.PUBLICATIONS_WRITER:
            return participant.publications
        if writer_id == wire.SUBSCRIPTIONS_WRITER:
            return participant.subscriptions
        return participant.graph


def _own_addresses(*, remote: bool) -> list[str]:
    """Return those of this host; with `remote` the one first under which others know it."""
    addresses = ['127.0.0.1']
    if remote:
        with (
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe,
            contextlib.suppress(OSError),
        ):
            # Sends nothing: asks the kernel which interface it would take.
            probe.connect((host.MULTICAST_ADDRESS, 9))
            addresses.insert(0, probe.getsockname()[0])
    return addresses


def _port(kind: int, locators: list[bytes]) -> int | None:
    for locator in locators:
        if len(locator) >= 24:
            found, port = struct.unpack_from('<iI', locator)
            if found == kind and 0 < port <= _LAST_PORT:
                return int(port)
    return None
