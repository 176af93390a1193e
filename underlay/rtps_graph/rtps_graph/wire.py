# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""RTPS messages as bytes: what a reader of discovery data sends and receives.

Section numbers are those of OMG DDSI-RTPS 2.2 (formal/2014-09-01).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
import socket
import struct

# Entity ids of the built-in endpoints (9.3.1.3).
PARTICIPANT = bytes.fromhex('000001c1')
SPDP_WRITER = bytes.fromhex('000100c2')
SPDP_READER = bytes.fromhex('000100c7')
PUBLICATIONS_WRITER = bytes.fromhex('000003c2')
PUBLICATIONS_READER = bytes.fromhex('000003c7')
SUBSCRIPTIONS_WRITER = bytes.fromhex('000004c2')
SUBSCRIPTIONS_READER = bytes.fromhex('000004c7')
UNKNOWN_ENTITY = bytes(4)

# Submessage kinds (9.4.5.1.1).
ACKNACK, HEARTBEAT, GAP, INFO_SOURCE, INFO_DESTINATION, DATA = 0x06, 0x07, 0x08, 0x0C, 0x0E, 0x15

# Parameter ids (9.6.2.2.2); the last three are eProsima's and ROS's use of standard ones.
PID_SENTINEL = 0x0001
PID_LEASE_DURATION = 0x0002
PID_TOPIC_NAME = 0x0005
PID_TYPE_NAME = 0x0007
PID_PROTOCOL_VERSION = 0x0015
PID_VENDOR_ID = 0x0016
PID_RELIABILITY = 0x001A
PID_LIVELINESS = 0x001B
PID_DURABILITY = 0x001D
PID_DEADLINE = 0x0023
PID_LIFESPAN = 0x002B
PID_USER_DATA = 0x002C
PID_DEFAULT_UNICAST_LOCATOR = 0x0031
PID_METATRAFFIC_UNICAST_LOCATOR = 0x0032
PID_PARTICIPANT_GUID = 0x0050
PID_BUILTIN_ENDPOINTS = 0x0058
PID_ENDPOINT_GUID = 0x005A
PID_KEY_HASH = 0x0070
PID_STATUS_INFO = 0x0071

LOCATOR_UDP_V4 = 1
LOCATOR_SHARED_MEMORY = 16  # LOCATOR_KIND_SHM of Fast DDS
PL_CDR_LE = bytes.fromhex('00030000')
# Vendor 0.0 is "unknown", so that no implementation takes this reader for one of its own.
# As Fast DDS 2.14 announces it, in its messages and in PID_PROTOCOL_VERSION.
PROTOCOL_VERSION = (2, 2)
_HEADER = b'RTPS' + bytes((*PROTOCOL_VERSION, 0, 0))


@dataclass(frozen=True)
class Submessage:
    """One submessage with the sender's GUID prefix in front of its entity ids."""

    kind: int
    source: bytes
    reader_id: bytes
    writer_id: bytes
    first: int = 0  # DATA: the sequence number; HEARTBEAT: the first; ACKNACK: the base
    last: int = 0  # HEARTBEAT: the last; GAP: one past the irrelevant range
    payload: bytes = b''
    disposed: bool = False
    irrelevant: tuple[int, ...] = ()


def header(prefix: bytes) -> bytes:
    return _HEADER + prefix


def _submessage(kind: int, flags: int, body: bytes) -> bytes:
    return struct.pack('<BBH', kind, flags | 1, len(body)) + body


def _sequence(number: int) -> bytes:
    return struct.pack('<iI', number >> 32, number & 0xFFFFFFFF)


def info_destination(prefix: bytes) -> bytes:
    return _submessage(INFO_DESTINATION, 0, prefix)


def data(reader_id: bytes, writer_id: bytes, sequence: int, payload: bytes) -> bytes:
    body = struct.pack('<HH', 0, 16) + reader_id + writer_id + _sequence(sequence) + payload
    return _submessage(DATA, 0x04, body)


def dispose(reader_id: bytes, writer_id: bytes, sequence: int, key: bytes) -> bytes:
    """Tell that the instance `key` (a GUID) is disposed of and unregistered (9.6.3.9)."""
    inline = parameter(PID_KEY_HASH, key) + parameter(PID_STATUS_INFO, bytes((0, 0, 0, 3)))
    payload = PL_CDR_LE + parameter(PID_PARTICIPANT_GUID, key) + sentinel()
    body = struct.pack('<HH', 0, 16) + reader_id + writer_id + _sequence(sequence)
    return _submessage(DATA, 0x02 | 0x08, body + inline + sentinel() + payload)


def heartbeat(reader_id: bytes, writer_id: bytes, first: int, last: int, count: int) -> bytes:
    body = reader_id + writer_id + _sequence(first) + _sequence(last) + struct.pack('<i', count)
    return _submessage(HEARTBEAT, 0, body)


def acknack(
    reader_id: bytes, writer_id: bytes, *, base: int, missing: set[int], count: int
) -> bytes:
    """Acknowledge everything below `base` and ask for `missing` (at most 256 from `base` on)."""
    wanted = [number - base for number in missing if 0 <= number - base < 256]
    bits = max(wanted) + 1 if wanted else 0
    words = [0] * ((bits + 31) // 32)
    for bit in wanted:
        words[bit // 32] |= 1 << (31 - bit % 32)
    body = reader_id + writer_id + _sequence(base) + struct.pack('<I', bits)
    body += struct.pack(f'<{len(words)}I', *words) + struct.pack('<i', count)
    return _submessage(ACKNACK, 0 if wanted else 0x02, body)


def parameter(pid: int, value: bytes) -> bytes:
    value += bytes(-len(value) % 4)
    return struct.pack('<HH', pid, len(value)) + value


def sentinel() -> bytes:
    return struct.pack('<HH', PID_SENTINEL, 0)


def string(text: str) -> bytes:
    encoded = text.encode() + b'\0'
    return struct.pack('<I', len(encoded)) + encoded


def udp_locator(address: str, port: int) -> bytes:
    return struct.pack('<iI', LOCATOR_UDP_V4, port) + bytes(12) + socket.inet_aton(address)


def parameters(payload: bytes) -> dict[int, list[bytes]]:
    """Split a parameter list (with its encapsulation header) into values by id.

    :raises ValueError: the list is cut short or not in a parameter-list encapsulation.
    """
    if len(payload) < 4 or payload[1] not in (2, 3):
        raise ValueError('the payload is no parameter list')
    order = '<' if payload[1] == 3 else '>'
    values: dict[int, list[bytes]] = {}
    offset = 4
    while offset + 4 <= len(payload):
        pid, length = struct.unpack_from(order + 'HH', payload, offset)
        if pid == PID_SENTINEL:
            return values
        offset += 4
        values.setdefault(pid & ~0x4000, []).append(payload[offset : offset + length])
        offset += length
    return values


def parse(datagram: bytes, *, own_prefix: bytes) -> Iterator[Submessage]:
    """Yield the submessages of a datagram that are meant for everybody or for `own_prefix`.

    Whatever is not RTPS, is cut short or is of no use to a reader of discovery data is left out.
    """
    if len(datagram) < 20 or datagram[:4] != b'RTPS':
        return
    source, ours, offset = datagram[8:20], True, 20
    while offset + 4 <= len(datagram):
        kind, flags, length = struct.unpack_from('<BBH', datagram, offset)
        order = '<' if flags & 1 else '>'
        if not flags & 1:
            length = struct.unpack_from('>H', datagram, offset + 2)[0]
        end = offset + 4 + length if length else len(datagram)
        body = datagram[offset + 4 : end]
        offset = end
        if kind == INFO_DESTINATION:
            ours = body[:12] in (own_prefix, bytes(12))
        elif kind == INFO_SOURCE and len(body) >= 20:
            source = body[8:20]
        elif ours:
            try:
                found = _read(kind, flags, order, source, body)
            except struct.error:
                return
            if found is not None:
                yield found


def _read(kind: int, flags: int, order: str, source: bytes, body: bytes) -> Submessage | None:
    def sequence(at: int) -> int:
        high, low = struct.unpack_from(order + 'iI', body, at)
        return (int(high) << 32) | int(low)

    if kind == DATA:
        return _read_data(flags, order, source, body, sequence(12))
    if kind == HEARTBEAT:
        return Submessage(kind, source, body[:4], body[4:8], sequence(8), sequence(16))
    if kind == ACKNACK:
        return Submessage(kind, source, body[:4], body[4:8], sequence(8))
    if kind == GAP:
        base = sequence(16)
        (bits,) = struct.unpack_from(order + 'I', body, 24)
        words = struct.unpack_from(f'{order}{(min(bits, 256) + 31) // 32}I', body, 28)
        listed = tuple(
            base + bit for bit in range(min(bits, 256)) if words[bit // 32] >> (31 - bit % 32) & 1
        )
        return Submessage(kind, source, body[:4], body[4:8], sequence(8), base, irrelevant=listed)
    return None


def _read_data(flags: int, order: str, source: bytes, body: bytes, number: int) -> Submessage:
    (to_inline,) = struct.unpack_from(order + 'H', body, 2)
    at, disposed = 4 + to_inline, False
    if flags & 0x02:
        while at + 4 <= len(body):
            pid, length = struct.unpack_from(order + 'HH', body, at)
            at += 4
            if pid == PID_SENTINEL:
                break
            if pid == PID_STATUS_INFO and min(length, len(body) - at) >= 4:
                disposed = bool(body[at + 3] & 0x03)
            at += length
    payload = body[at:] if flags & 0x0C else b''
    return Submessage(DATA, source, body[4:8], body[8:12], number, 0, payload, disposed)
