# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""metadata.yaml: version 9 of rosbag2's format is written, older ones are read as well."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from rosbag2_py import _qos
from rosbag2_py._metadata import BagMetadata, FileInformation, TopicInformation, TopicMetadata
from rosbag2_py.errors import BagError

FILE_NAME = 'metadata.yaml'
_ROOT = 'rosbag2_bagfile_information'
# What yaml and from_dict raise of a text that is something else.
_WRONG = (yaml.YAMLError, AttributeError, LookupError, RecursionError, TypeError, ValueError)


class MetadataIo:
    """Reads and writes the metadata.yaml in the folder of a bag."""

    def write_metadata(self, uri: str, metadata: BagMetadata) -> None:
        content = {_ROOT: to_dict(metadata)}
        path = Path(uri, FILE_NAME)
        try:
            path.write_text(dump(content), encoding='utf-8')
        except OSError:
            path.unlink(missing_ok=True)  # half of it would hide a bag that can be read without
            raise

    def read_metadata(self, uri: str) -> BagMetadata:
        """Read it; the size is that of all files in the folder.

        :raises BagError: there is none, or it is not of this format.
        """
        path = Path(uri, FILE_NAME)
        try:
            metadata = from_dict(yaml.safe_load(path.read_text(encoding='utf-8'))[_ROOT])
            files = (file for file in path.parent.rglob('*') if file.is_file())
            metadata.bag_size = sum(file.stat().st_size for file in files)
        except (*_WRONG, OSError) as error:
            raise BagError(f"'{path}' cannot be read: {_why(error)}") from None
        return metadata

    def metadata_file_exists(self, uri: str) -> bool:
        return Path(uri, FILE_NAME).exists()

    def serialize_metadata(self, metadata: BagMetadata) -> str:
        return dump(to_dict(metadata))

    def deserialize_metadata(self, serialized_metadata: str) -> BagMetadata:
        try:
            return from_dict(yaml.safe_load(serialized_metadata))
        except _WRONG as error:
            raise BagError(f'no metadata of a bag: {_why(error)}') from None


def dump(content: Any) -> str:
    return str(yaml.safe_dump(content, sort_keys=False))


def to_dict(bag: BagMetadata) -> dict[str, Any]:
    return {
        'version': bag.version,
        'storage_identifier': bag.storage_identifier,
        'duration': {'nanoseconds': bag._duration_ns},
        'starting_time': {'nanoseconds_since_epoch': bag._starting_time_ns},
        'message_count': bag.message_count,
        'topics_with_message_count': [
            {
                'topic_metadata': _topic_to_dict(topic.topic_metadata, bag.version),
                'message_count': topic.message_count,
            }
            for topic in bag.topics_with_message_count
        ],
        'compression_format': bag.compression_format,
        'compression_mode': bag.compression_mode,
        'relative_file_paths': bag.relative_file_paths,
        'files': [
            {
                'path': file.path,
                'starting_time': {'nanoseconds_since_epoch': file._starting_time_ns},
                'duration': {'nanoseconds': file._duration_ns},
                'message_count': file.message_count,
            }
            for file in bag.files
        ],
        'custom_data': bag.custom_data or None,
        'ros_distro': bag.ros_distro,
    }


def _topic_to_dict(topic: TopicMetadata, version: int) -> dict[str, Any]:
    profiles: Any = _qos.to_dicts(topic.offered_qos_profiles)
    return {
        'name': topic.name,
        'type': topic.type,
        'serialization_format': topic.serialization_format,
        'offered_qos_profiles': profiles if version >= 9 else dump(profiles),
        'type_description_hash': topic.type_description_hash,
    }


def from_dict(content: Any) -> BagMetadata:
    """
    Read what metadata.yaml has below its first line.

    :raises LookupError, TypeError, ValueError: it is not of this format.
    """
    if not isinstance(content, dict):
        raise TypeError('it has no entries')
    return BagMetadata(
        version=content['version'],
        storage_identifier=content['storage_identifier'],
        relative_file_paths=content['relative_file_paths'],
        files=[
            FileInformation(
                file['path'],
                Nanoseconds(file['starting_time']['nanoseconds_since_epoch']),
                Nanoseconds(file['duration']['nanoseconds']),
                file['message_count'],
            )
            for file in content.get('files') or []
        ],
        duration=Nanoseconds(content['duration']['nanoseconds']),
        starting_time=Nanoseconds(content['starting_time']['nanoseconds_since_epoch']),
        message_count=content['message_count'],
        topics_with_message_count=[
            TopicInformation(_topic_from_dict(topic['topic_metadata']), topic['message_count'])
            for topic in content['topics_with_message_count']
        ],
        compression_format=content.get('compression_format') or '',
        compression_mode=content.get('compression_mode') or '',
        custom_data={str(k): str(v) for k, v in (content.get('custom_data') or {}).items()},
        ros_distro=content.get('ros_distro') or '',
    )


def _topic_from_dict(topic: dict[str, Any]) -> TopicMetadata:
    profiles = topic.get('offered_qos_profiles')
    if isinstance(profiles, str):  # a text of its own before version 9
        profiles = yaml.safe_load(profiles)
    return TopicMetadata(
        0,
        topic['name'],
        topic['type'],
        topic['serialization_format'],
        _qos.from_dicts(profiles),
        topic.get('type_description_hash') or '',
    )


class Nanoseconds:
    """A time or a duration, without rclpy."""

    def __init__(self, nanoseconds: int) -> None:
        self.nanoseconds = nanoseconds


def _why(error: Exception) -> str:
    text = ' '.join(str(error).split())
    return f'it lacks {text}' if isinstance(error, KeyError) else text
