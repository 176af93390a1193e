# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the observer announces: a participant with one reader, that of the graph topic."""

from __future__ import annotations

from collections.abc import Sequence
import struct

from rtps_graph import wire
from rtps_graph.participant import GRAPH_TOPIC, GRAPH_TYPE, GRAPH_TYPE_HASH

GRAPH_READER = bytes.fromhex('00000104')  # a reader without key, 9.3.1.2
# Built-in endpoints (9.3.2): participant announcer and detector, detectors of publications and
# subscriptions, announcer of subscriptions.
_OWN_ENDPOINTS = 0b111011
_LEASE_SEC = 10
_TYPE_HASH = f'typehash={GRAPH_TYPE_HASH};'.encode()  # as rmw has it in the user data
_RELIABLE, _TRANSIENT_LOCAL = 2, 1


def participant(prefix: bytes, addresses: Sequence[str], port: int) -> bytes:
    """Make the message that announces the observer."""

    def locators(pid: int) -> bytes:
        return b''.join(wire.parameter(pid, wire.udp_locator(a, port)) for a in addresses)

    payload = wire.PL_CDR_LE + b''.join(
        (
            wire.parameter(wire.PID_PROTOCOL_VERSION, bytes(wire.PROTOCOL_VERSION)),
            wire.parameter(wire.PID_VENDOR_ID, bytes((0, 0))),
            wire.parameter(wire.PID_PARTICIPANT_GUID, prefix + wire.PARTICIPANT),
            locators(wire.PID_METATRAFFIC_UNICAST_LOCATOR),
            locators(wire.PID_DEFAULT_UNICAST_LOCATOR),
            wire.parameter(wire.PID_LEASE_DURATION, struct.pack('<iI', _LEASE_SEC, 0)),
            wire.parameter(wire.PID_BUILTIN_ENDPOINTS, struct.pack('<I', _OWN_ENDPOINTS)),
            wire.sentinel(),
        )
    )
    return wire.header(prefix) + wire.data(wire.SPDP_READER, wire.SPDP_WRITER, 1, payload)


def removal(prefix: bytes) -> bytes:
    """Make the message that takes the announcement back."""
    return wire.header(prefix) + wire.dispose(
        wire.SPDP_READER, wire.SPDP_WRITER, 2, prefix + wire.PARTICIPANT
    )


def graph_reader(prefix: bytes, destination: bytes, count: int) -> bytes:
    """Make the message that offers the reader to one participant, with a heartbeat."""
    payload = wire.PL_CDR_LE + b''.join(
        (
            wire.parameter(wire.PID_PARTICIPANT_GUID, prefix + wire.PARTICIPANT),
            wire.parameter(wire.PID_ENDPOINT_GUID, prefix + GRAPH_READER),
            wire.parameter(wire.PID_TOPIC_NAME, wire.string(GRAPH_TOPIC)),
            wire.parameter(wire.PID_TYPE_NAME, wire.string(GRAPH_TYPE)),
            wire.parameter(wire.PID_USER_DATA, struct.pack('<I', len(_TYPE_HASH)) + _TYPE_HASH),
            wire.parameter(wire.PID_RELIABILITY, struct.pack('<IiI', _RELIABLE, 0, 0)),
            wire.parameter(wire.PID_DURABILITY, struct.pack('<I', _TRANSIENT_LOCAL)),
            wire.sentinel(),
        )
    )
    reader, writer = wire.SUBSCRIPTIONS_READER, wire.SUBSCRIPTIONS_WRITER
    return (
        wire.header(prefix)
        + wire.info_destination(destination)
        + wire.data(reader, writer, 1, payload)
        + wire.heartbeat(reader, writer, 1, 1, count)
    )
