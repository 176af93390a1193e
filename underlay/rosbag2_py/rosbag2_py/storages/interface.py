# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What each storage offers: to read one file of a bag, and to write one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, TypeVar

from rosbag2_py._metadata import BagMetadata, MessageDefinition, TopicInformation, TopicMetadata
from rosbag2_py._metadata_io import Nanoseconds
from rosbag2_py._options import ReadOrder

ROS_DISTRO = 'jazzy'

F = TypeVar('F', bound='StoredFile')
Key = tuple[int, ...]


class StoredMessage(NamedTuple):
    """A message, with its times in nanoseconds and its place in the order of reading."""

    key: Key
    topic: str
    data: bytes
    time_ns: int  # when it was received
    published_ns: int  # the same where the storage has none


class Start(NamedTuple):
    """From where to read on: a time, or what comes behind a message of a certain place."""

    time_ns: int
    after: Key | None = None


@dataclass
class Span:
    """The times of some messages, and how many they are."""

    start_ns: int = 0
    end_ns: int = 0
    count: int = 0

    def add(self, time_ns: int) -> None:
        self.extend(Span(time_ns, time_ns, 1))

    def extend(self, other: Span) -> None:
        """Take the messages of another one in."""
        if other.count:
            self.start_ns = min(self.start_ns, other.start_ns) if self.count else other.start_ns
            self.end_ns = max(self.end_ns, other.end_ns) if self.count else other.end_ns
            self.count += other.count

    def begins_after(self, time_ns: int) -> bool:
        """Return whether no message is as early; so it is where there is none."""
        return not self.count or time_ns < self.start_ns

    @property
    def start(self) -> Nanoseconds:
        return Nanoseconds(self.start_ns)

    @property
    def duration(self) -> Nanoseconds:
        return Nanoseconds(self.end_ns - self.start_ns)


class Contents(NamedTuple):
    """
    What a file holds.

    :ivar told: what only who recorded it knew, as custom_data; nothing else of it counts.
    :ivar size: how many bytes it takes.
    """

    topics: list[TopicInformation]
    span: Span
    told: BagMetadata
    size: int


class StoredFile(ABC):
    """
    A file that is read; close it, or use it as a context manager.

    :ivar caution: what is to be told of a file whose recording has not ended as it should.
    :ivar has_index: whether messages can be read in the order of their times.
    :ivar seek_goes_on: whether to seek the time of the message that was read last goes behind
        that message, and not before the first of that time.
    :raises BagError: it is no file of that storage, or is damaged.
    """

    path: Path
    caution = ''
    has_index = True
    seek_goes_on = False

    def __enter__(self: F) -> F:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """May be called twice."""

    @property
    @abstractmethod
    def contents(self) -> Contents:
        """What it holds, counted from the file itself; raises BagError as the constructor."""

    @abstractmethod
    def definitions(self) -> list[MessageDefinition]: ...

    @abstractmethod
    def why_not(self, order: ReadOrder) -> str:
        """Tell why the file cannot be read in an order; nothing where it can."""

    @abstractmethod
    def messages(
        self, start: Start, order: ReadOrder, wanted: Callable[[str], bool]
    ) -> Iterator[StoredMessage]:
        """
        Yield messages of the topics that are wanted, without keeping them.

        :raises BagError: the file is damaged.
        """


class FileWriter(ABC):
    """A file that is written; what is interrupted within a call is not whole."""

    @property
    @abstractmethod
    def size(self) -> int:
        """About how many bytes the file has."""

    @abstractmethod
    def add_topic(self, topic: TopicMetadata, definition: MessageDefinition) -> None: ...

    @abstractmethod
    def remove_topic(self, name: str) -> None: ...

    @abstractmethod
    def write(
        self, topic_name: str, data: bytes, received_ns: int, published_ns: int, number: int
    ) -> None:
        """Write a message, which is that of this number of its topic."""

    @abstractmethod
    def flush(self) -> None:
        """Let other programs read what was written, as far as that is cheap."""

    @abstractmethod
    def finish(self, metadata: BagMetadata) -> None:
        """End the file, and close it whatever happens; may be called twice."""


@dataclass(frozen=True, kw_only=True)
class Storage:
    """
    A way to store the files of a bag.

    :ivar magic: what its files begin with.
    :ivar presets: its preset profiles; 'none' is the first.
    :ivar smallest_file_bytes: the least that a file may be limited to.
    :ivar write: opens a new file with one of the presets.
    """

    id: str
    suffix: str
    magic: bytes
    presets: tuple[str, ...]
    smallest_file_bytes: int
    read: Callable[[Path], StoredFile]
    write: Callable[[Path, str], FileWriter]
