# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write one MCAP file."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from mcap.writer import CompressionType, Writer

from rosbag2_py import _qos
from rosbag2_py._metadata import BagMetadata, MessageDefinition, TopicMetadata
from rosbag2_py._metadata_io import dump, MetadataIo
from rosbag2_py.storages.interface import FileWriter, ROS_DISTRO


class McapWriter(FileWriter):
    """Writes chunks of about a megabyte, compressed where the preset begins with 'zstd'."""

    def __init__(self, path: Path, preset: str) -> None:
        self._file = path.open('wb')
        is_compressed = preset.startswith('zstd')
        compression = CompressionType.ZSTD if is_compressed else CompressionType.NONE
        self._writer = Writer(self._file, compression=compression)
        self._writer.start(profile='ros2', library='husky playpen lab rosbag2_py')
        try:
            # Who is killed soon leaves a file without messages, not one of 0 bytes.
            self._file.flush()
        except BaseException:
            with suppress(OSError):
                self._file.close()
            raise
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}

    @property
    def size(self) -> int:
        return self._file.tell()

    def add_topic(self, topic: TopicMetadata, definition: MessageDefinition) -> None:
        if topic.type not in self._schemas:
            text = definition.encoded_message_definition.encode()
            schema = self._writer.register_schema(topic.type, definition.encoding, text)
            self._schemas[topic.type] = schema
        self._channels[topic.name] = self._writer.register_channel(
            topic.name,
            topic.serialization_format,
            self._schemas[topic.type],
            {
                'offered_qos_profiles': dump(_qos.to_dicts(topic.offered_qos_profiles)),
                'topic_type_hash': topic.type_description_hash,
            },
        )

    def remove_topic(self, name: str) -> None:
        """Leave it in the file, from which nothing can be taken."""
        del self._channels[name]

    def write(
        self, topic_name: str, data: bytes, received_ns: int, published_ns: int, number: int
    ) -> None:
        channel = self._channels[topic_name]
        self._writer.add_message(channel, received_ns, data, published_ns, number)

    def flush(self) -> None:
        """Give all chunks that are full to the operating system."""
        if not self._file.closed:
            self._file.flush()

    def finish(self, metadata: BagMetadata) -> None:
        if self._file.closed:
            return
        told = MetadataIo().serialize_metadata(metadata)
        record = {'ROS_DISTRO': ROS_DISTRO, 'serialized_metadata': told}
        with self._file:
            self._writer.add_metadata('rosbag2', record)
            self._writer.finish()
