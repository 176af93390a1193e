# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The metadata.yaml of a bag: version 9 of rosbag2's format, that of ROS 2 Jazzy."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ros2cli.errors import CommandError
import yaml

FILE_NAME = 'metadata.yaml'
_ROOT = 'rosbag2_bagfile_information'
ROS_DISTRO = 'jazzy'
# What rosbag2 writes for a duration without end.
_FOREVER = {'sec': 9223372036, 'nsec': 854775807}


@dataclass
class TopicRecord:
    """A topic of a bag."""

    name: str
    type: str
    type_hash: str = ''
    reliable: bool = True
    transient_local: bool = False
    count: int = 0

    def qos_profiles(self) -> list[dict[str, Any]]:
        return [
            {
                'history': 'keep_last',
                'depth': 10,
                'reliability': 'reliable' if self.reliable else 'best_effort',
                'durability': 'transient_local' if self.transient_local else 'volatile',
                'deadline': dict(_FOREVER),
                'lifespan': dict(_FOREVER),
                'liveliness': 'automatic',
                'liveliness_lease_duration': dict(_FOREVER),
                'avoid_ros_namespace_conventions': False,
            }
        ]


@dataclass
class BagRecord:
    """A bag as a whole."""

    file: str
    topics: list[TopicRecord] = field(default_factory=list)
    start_ns: int = 0
    end_ns: int = 0

    @property
    def count(self) -> int:
        return sum(topic.count for topic in self.topics)

    @property
    def duration_ns(self) -> int:
        return max(0, self.end_ns - self.start_ns)


def to_dict(bag: BagRecord) -> dict[str, Any]:
    start = {'nanoseconds_since_epoch': bag.start_ns}
    duration = {'nanoseconds': bag.duration_ns}
    return {
        'version': 9,
        'storage_identifier': 'mcap',
        'duration': duration,
        'starting_time': start,
        'message_count': bag.count,
        'topics_with_message_count': [
            {
                'topic_metadata': {
                    'name': topic.name,
                    'type': topic.type,
                    'serialization_format': 'cdr',
                    'offered_qos_profiles': topic.qos_profiles(),
                    'type_description_hash': topic.type_hash,
                },
                'message_count': topic.count,
            }
            for topic in bag.topics
        ],
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [bag.file],
        'files': [
            {
                'path': bag.file,
                'starting_time': dict(start),
                'duration': dict(duration),
                'message_count': bag.count,
            }
        ],
        'custom_data': None,
        'ros_distro': ROS_DISTRO,
    }


def dump(content: Any) -> str:
    return yaml.safe_dump(content, sort_keys=False)


def write(folder: Path, bag: BagRecord) -> None:
    (folder / FILE_NAME).write_text(dump({_ROOT: to_dict(bag)}), encoding='utf-8')


def bag_files(path: Path) -> list[Path]:
    """List the MCAP files of a bag, given as its folder or as one file.

    :raises CommandError: there is no bag, or it is stored in another format.
    """
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise CommandError(f"Bag path '{path}' does not exist!")
    named = []
    if (path / FILE_NAME).is_file():
        named = _named_files(path / FILE_NAME)
    files = [path / name for name in named] or sorted(path.glob('*.mcap'))
    if not files:
        others = sorted(path.glob('*.db3'))
        reason = 'it is stored as sqlite3, which needs a full ROS 2' if others else 'it has none'
        raise CommandError(f"'{path}' holds no MCAP file: {reason}")
    for file in files:
        if file.suffix != '.mcap':
            raise CommandError(f"'{file}' is no MCAP file; other storages need a full ROS 2")
        if not file.is_file():
            raise CommandError(f"'{file}', named in {path / FILE_NAME}, does not exist")
    return files


def _named_files(path: Path) -> list[str]:
    try:
        root = yaml.safe_load(path.read_text(encoding='utf-8'))[_ROOT]
        return [str(name) for name in root['relative_file_paths']]
    except (yaml.YAMLError, OSError, KeyError, TypeError, ValueError) as error:
        raise CommandError(f"'{path}' cannot be read: {' '.join(str(error).split())}") from None
