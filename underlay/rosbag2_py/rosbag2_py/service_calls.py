# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Count the calls of services that a bag holds, from the events in it."""

from __future__ import annotations

from dataclasses import dataclass, field
import struct

from rosbag2_py._metadata import TopicInformation
from rosbag2_py._options import ConverterOptions, StorageFilter, StorageOptions
from rosbag2_py._reader import SequentialReader
from rosbag2_py.errors import BagError

# The start of an event in CDR: the field `info`, a service_msgs/msg/ServiceEventInfo.
_INFO = '4x B 3x 8x 16s 4x q'  # event_type, client_gid, sequence_number
_REQUESTS = (0, 1)  # REQUEST_SENT, REQUEST_RECEIVED
_RESPONSES = (2, 3)  # RESPONSE_SENT, RESPONSE_RECEIVED


@dataclass
class Calls:
    """
    Requests and responses of a service, by client and number, as upstream counts them.

    Fast DDS names a client otherwise to the service than to the client itself: with it, a call
    that both tell of counts twice, upstream as well.
    """

    requests: set[tuple[bytes, int]] = field(default_factory=set)
    responses: set[tuple[bytes, int]] = field(default_factory=set)


def count(options: StorageOptions, services: list[TopicInformation]) -> list[Calls]:
    """
    Return the calls of each of these services.

    :raises BagError: the bag cannot be read, or holds something else than events there.
    """
    calls = {each.topic_metadata.name: Calls() for each in services}
    if not calls:
        return []
    reader = SequentialReader()
    reader.open(options, ConverterOptions())
    reader.set_filter(StorageFilter(topics=list(calls), services_events=list(calls)))
    while reader.has_next():
        name, data, _ = reader.read_next()
        event_type, client, number = _info(name, data)
        if event_type in _REQUESTS:
            calls[name].requests.add((client, number))
        elif event_type in _RESPONSES:
            calls[name].responses.add((client, number))
    return list(calls.values())


def _info(name: str, data: bytes) -> tuple[int, bytes, int]:
    little_endian = len(data) > 1 and data[1] & 1
    try:
        found = struct.unpack_from(f'{"<" if little_endian else ">"}{_INFO}', data)
    except struct.error:
        raise BagError(
            f"'{name}' holds {len(data)} bytes that are no event of a service"
        ) from None
    return found[0], found[1], found[2]
