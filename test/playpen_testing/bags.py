# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Bags that the tests write and read by `rosbag2_py`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rclpy.serialization import deserialize_message, serialize_message
from rosbag2_py import (
    ConverterOptions,
    SequentialReader,
    SequentialWriter,
    StorageOptions,
    TopicMetadata,
)
from std_msgs.msg import String
import yaml

READ = tuple[str, bytes, int]


def opened_writer(
    folder: Path, *topics: str, storage_id: str = 'mcap', **options: Any
) -> SequentialWriter:
    writer = SequentialWriter()
    writer.open(StorageOptions(str(folder), storage_id, **options), ConverterOptions('', ''))
    for topic in topics:
        writer.create_topic(TopicMetadata(0, topic, 'std_msgs/msg/String', 'cdr'))
    return writer


def opened_reader(path: Path, storage_id: str = '') -> SequentialReader:
    reader = SequentialReader()
    reader.open(StorageOptions(uri=str(path), storage_id=storage_id), ConverterOptions('', ''))
    return reader


def rest_of(reader: SequentialReader) -> list[READ]:
    def messages() -> Iterator[READ]:
        while reader.has_next():
            yield reader.read_next()

    return list(messages())


def times_of(reader: SequentialReader) -> list[int]:
    return [each[2] for each in rest_of(reader)]


def string(number: int) -> bytes:
    return bytes(serialize_message(String(data=f'number {number}')))


def numbers_in(messages: list[READ]) -> list[int]:
    texts = [deserialize_message(data, String).data for _, data, _ in messages]
    return [int(text.split()[1]) for text in texts]


def write_metadata(folder: Path, version: int, qos: Any, file: str = 'real_0.mcap') -> None:
    topic = {
        'name': '/chatter',
        'type': 'std_msgs/msg/String',
        'serialization_format': 'cdr',
        'offered_qos_profiles': qos,
    }
    content = {
        'version': version,
        'storage_identifier': 'mcap',
        'duration': {'nanoseconds': 99},
        'starting_time': {'nanoseconds_since_epoch': 0},
        'message_count': 100,
        'topics_with_message_count': [{'topic_metadata': topic, 'message_count': 100}],
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [file],
    }
    text = yaml.safe_dump({'rosbag2_bagfile_information': content})
    (folder / 'metadata.yaml').write_text(text)
