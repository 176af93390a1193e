# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write a bag."""

from __future__ import annotations

from pathlib import Path

from mcap.writer import CompressionType, Writer
from ros2cli import definitions
from ros2cli.errors import CommandError

from ros2bag import metadata
from ros2bag.metadata import BagRecord, TopicRecord

COMPRESSIONS = {
    'none': CompressionType.NONE,
    'fastwrite': CompressionType.NONE,
    'zstd_fast': CompressionType.ZSTD,
    'zstd_small': CompressionType.ZSTD,
}
_SEPARATOR = '=' * 80


class BagWriter:
    """A bag that is being written; close it, or use it as a context manager.

    :raises CommandError: the folder exists or cannot be made.
    """

    def __init__(self, folder: Path, *, preset: str = 'none') -> None:
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            raise CommandError(
                f"Output folder '{folder}' already exists; choose another one with -o"
            ) from None
        except OSError as error:
            raise CommandError(f"'{folder}' cannot be made: {error.strerror}") from None
        self.folder = folder
        self.bag = BagRecord(f'{folder.name}_0.mcap')
        self._channels: dict[str, tuple[int, TopicRecord]] = {}
        self._file = (folder / self.bag.file).open('wb')
        self._writer = Writer(self._file, compression=COMPRESSIONS[preset])
        self._writer.start(profile='ros2', library='husky playpen lab ros2 bag')

    def __enter__(self) -> BagWriter:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def add_topic(self, topic: TopicRecord) -> None:
        schema = self._writer.register_schema(
            topic.type, 'ros2msg', message_definition(topic.type).encode()
        )
        channel = self._writer.register_channel(
            topic.name,
            'cdr',
            schema,
            {
                'offered_qos_profiles': metadata.dump(topic.qos_profiles()),
                'topic_type_hash': topic.type_hash,
            },
        )
        self._channels[topic.name] = channel, topic
        self.bag.topics.append(topic)

    def write(self, topic_name: str, data: bytes, received_ns: int, published_ns: int) -> None:
        channel, topic = self._channels[topic_name]
        self._writer.add_message(channel, received_ns, data, published_ns, topic.count)
        topic.count += 1
        if self.bag.count == 1:
            self.bag.start_ns = self.bag.end_ns = received_ns
        self.bag.start_ns = min(self.bag.start_ns, received_ns)
        self.bag.end_ns = max(self.bag.end_ns, received_ns)

    def close(self) -> None:
        """Finish the files; may be called twice."""
        if self._file.closed:
            return
        self._writer.add_metadata(
            'rosbag2',
            {
                'ROS_DISTRO': metadata.ROS_DISTRO,
                'serialized_metadata': metadata.dump(metadata.to_dict(self.bag)),
            },
        )
        self._writer.finish()
        self._file.close()
        metadata.write(self.folder, self.bag)


def message_definition(type_name: str) -> str:
    """Join the definitions of a message and of all that it contains, as MCAP's ros2msg asks."""
    parts = [definitions.text_of(type_name)]
    for contained in definitions.contained_types(type_name):
        short = contained.replace('/msg/', '/')
        parts.append(f'{_SEPARATOR}\nMSG: {short}\n{definitions.text_of(contained)}')
    return '\n'.join(part.rstrip('\n') + '\n' for part in parts).replace('\n\n====', '\n====')
