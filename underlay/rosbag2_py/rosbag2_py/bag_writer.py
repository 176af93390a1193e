# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write a bag."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from mcap.writer import CompressionType, Writer

from rosbag2_py import _qos
from rosbag2_py._message_definitions import LocalMessageDefinitionSource
from rosbag2_py._metadata import (
    BagMetadata,
    FileInformation,
    MessageDefinition,
    TopicInformation,
    TopicMetadata,
)
from rosbag2_py._metadata_io import dump, MetadataIo, Nanoseconds
from rosbag2_py.errors import BagError

ROS_DISTRO = 'jazzy'
# What rosbag2 writes for a duration without end.
_FOREVER = {'sec': 9223372036, 'nsec': 854775807}
COMPRESSIONS = {
    'none': CompressionType.NONE,
    'fastwrite': CompressionType.NONE,
    'zstd_fast': CompressionType.ZSTD,
    'zstd_small': CompressionType.ZSTD,
}
"""The preset profiles of the storage."""


@dataclass
class Limits:
    """When a new file is begun: after so many bytes or seconds; 0 for never."""

    file_bytes: int = 0
    file_sec: int = 0


@dataclass
class _Topic:
    metadata: TopicMetadata
    definition: MessageDefinition
    channel: int = 0
    count: int = 0


@dataclass
class _Span:
    """The times of some messages, and how many they are."""

    start_ns: int = 0
    end_ns: int = 0
    count: int = 0

    def add(self, time_ns: int) -> None:
        self.start_ns = min(self.start_ns, time_ns) if self.count else time_ns
        self.end_ns = max(self.end_ns, time_ns)
        self.count += 1

    @property
    def start(self) -> Nanoseconds:
        return Nanoseconds(self.start_ns)

    @property
    def duration(self) -> Nanoseconds:
        return Nanoseconds(self.end_ns - self.start_ns)


def offered_qos(*, reliable: bool, transient_local: bool) -> _qos.QoS:
    """Return what a publisher offers, with limits of time that it does not have."""
    return _qos.from_dicts(
        [
            {
                'history': 'keep_last',
                'depth': 10,
                'reliability': 'reliable' if reliable else 'best_effort',
                'durability': 'transient_local' if transient_local else 'volatile',
                'deadline': _FOREVER,
                'lifespan': _FOREVER,
                'liveliness': 'automatic',
                'liveliness_lease_duration': _FOREVER,
                'avoid_ros_namespace_conventions': False,
            }
        ]
    )[0]


class BagWriter:
    """
    A bag that is being written; close it, or use it as a context manager.

    It is not for several threads, and what is interrupted within a call is not whole.

    :raises BagError: the folder exists or cannot be made.
    """

    def __init__(
        self,
        folder: Path,
        *,
        preset: str = 'none',
        limits: Limits | None = None,
        custom_data: dict[str, str] | None = None,
    ) -> None:
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            raise BagError(
                f"Output folder '{folder}' already exists, and no bag is written over: choose "
                'another name, or remove it'
            ) from None
        except OSError as error:
            raise BagError(f"'{folder}' cannot be made: {error.strerror}") from None
        self.folder = folder
        self._preset = preset
        self._limits = limits or Limits()
        self._custom_data = custom_data or {}
        self._topics: dict[str, _Topic] = {}
        self._all = _Span()
        self._files: list[tuple[str, _Span]] = []
        self._begin_file()

    def __enter__(self) -> BagWriter:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def message_count(self) -> int:
        return self._all.count

    def add_topic(
        self, metadata: TopicMetadata, definition: MessageDefinition | None = None
    ) -> None:
        """
        Add a topic before its first message.

        :param definition: that of its type; looked up where none is given.
        """
        if definition is None:
            definition = LocalMessageDefinitionSource().get_full_text(metadata.type)
        self._topics[metadata.name] = _Topic(metadata, definition)
        self._register(self._topics[metadata.name])

    def remove_topic(self, name: str) -> None:
        """Leave a topic out of metadata.yaml; what was written stays in the file."""
        del self._topics[name]

    def write(self, topic_name: str, data: bytes, received_ns: int, published_ns: int) -> None:
        topic = self._topics[topic_name]
        if self._is_full(received_ns):
            self.split()
        self._writer.add_message(topic.channel, received_ns, data, published_ns, topic.count)
        topic.count += 1
        self._all.add(received_ns)
        self._files[-1][1].add(received_ns)

    def flush(self) -> None:
        """Give all chunks that are full to the operating system."""
        if not self._file.closed:
            self._file.flush()

    def split(self) -> None:
        """Begin a new file."""
        self._finish_file()
        self._begin_file()

    def close(self) -> None:
        """Finish the files; may be called twice."""
        if self._file.closed:
            return
        self._finish_file()
        MetadataIo().write_metadata(str(self.folder), self._metadata())

    def _is_full(self, time_ns: int) -> bool:
        span, limits = self._files[-1][1], self._limits
        if limits.file_bytes and self._file.tell() >= limits.file_bytes:
            return True
        return bool(
            limits.file_sec
            and span.count
            and time_ns - span.start_ns > limits.file_sec * 1_000_000_000
        )

    def _begin_file(self) -> None:
        name = f'{self.folder.name or self.folder.resolve().name}_{len(self._files)}.mcap'
        self._files.append((name, _Span()))
        self._file = (self.folder / name).open('wb')
        self._writer = Writer(self._file, compression=COMPRESSIONS[self._preset])
        self._writer.start(profile='ros2', library='husky playpen lab rosbag2_py')
        self._schemas: dict[str, int] = {}
        for topic in self._topics.values():
            self._register(topic)

    def _register(self, topic: _Topic) -> None:
        metadata, definition = topic.metadata, topic.definition
        if metadata.type not in self._schemas:
            text = definition.encoded_message_definition.encode()
            schema = self._writer.register_schema(metadata.type, definition.encoding, text)
            self._schemas[metadata.type] = schema
        topic.channel = self._writer.register_channel(
            metadata.name,
            metadata.serialization_format,
            self._schemas[metadata.type],
            {
                'offered_qos_profiles': dump(_qos.to_dicts(metadata.offered_qos_profiles)),
                'topic_type_hash': metadata.type_description_hash,
            },
        )

    def _finish_file(self) -> None:
        told = MetadataIo().serialize_metadata(self._metadata())
        record = {'ROS_DISTRO': ROS_DISTRO, 'serialized_metadata': told}
        with self._file:
            self._writer.add_metadata('rosbag2', record)
            self._writer.finish()

    def _metadata(self) -> BagMetadata:
        topics = self._topics.values()
        return BagMetadata(
            storage_identifier='mcap',
            relative_file_paths=[name for name, _ in self._files],
            files=[
                FileInformation(name, span.start, span.duration, span.count)
                for name, span in self._files
            ],
            duration=self._all.duration,
            starting_time=self._all.start,
            message_count=sum(topic.count for topic in topics),
            topics_with_message_count=[
                TopicInformation(topic.metadata, topic.count) for topic in topics
            ],
            custom_data=self._custom_data,
            ros_distro=ROS_DISTRO,
        )
