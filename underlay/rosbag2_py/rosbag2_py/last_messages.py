# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The last messages, which are written when somebody asks for them: the snapshot mode."""

from __future__ import annotations

from collections import deque

from rosbag2_py._log import warn
from rosbag2_py.bag_writer import BagWriter


class LastMessages:
    """
    Keeps the last messages of all topics in memory, as a `BagWriter` is told them.

    :param most_bytes: what is kept at most; the oldest go first.
    """

    def __init__(self, writer: BagWriter, most_bytes: int) -> None:
        self._writer = writer
        self._most_bytes = most_bytes
        self._bytes = 0
        self._kept: deque[tuple[str, bytes, int, int]] = deque()

    def write(self, topic_name: str, data: bytes, received_ns: int, published_ns: int) -> None:
        """Keep a message; one that has no room by itself is dropped."""
        if len(data) > self._most_bytes:
            warn(
                f"A message of '{topic_name}' is dropped: it has {len(data)} bytes, and a "
                f'snapshot {self._most_bytes} at most'
            )
            return
        self._kept.append((topic_name, data, received_ns, published_ns))
        self._bytes += len(data)
        while self._bytes > self._most_bytes:
            self._bytes -= len(self._kept.popleft()[1])

    def take(self) -> None:
        """Write what is kept, but for topics that were removed since, and keep none of it."""
        kept, self._kept, self._bytes = self._kept, deque(), 0
        for message in kept:
            if self._writer.has_topic(message[0]):
                self._writer.write(*message)
