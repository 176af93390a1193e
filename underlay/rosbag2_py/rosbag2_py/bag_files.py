# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a bag, and what they hold together."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from rosbag2_py import _qos
from rosbag2_py._metadata import BagMetadata, FileInformation, TopicInformation, TopicMetadata
from rosbag2_py._metadata_io import FILE_NAME, MetadataIo, Nanoseconds
from rosbag2_py.errors import BagError
from rosbag2_py.mcap_file import McapFile


def find(path: Path) -> list[Path]:
    """
    List the MCAP files of a bag, given as its folder or as one file.

    :raises BagError: there is no bag, or it is stored in another format.
    """
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise BagError(f"Bag path '{path}' does not exist!")
    named: list[str] = []
    if (path / FILE_NAME).is_file():
        named = MetadataIo().read_metadata(str(path)).relative_file_paths
    # behind file 9 comes file 10
    found = sorted(path.glob('*.mcap'), key=lambda file: (len(file.name), file.name))
    files = [path / name for name in named] or found
    if not files:
        others = sorted(path.glob('*.db3'))
        reason = 'it is stored as sqlite3, which needs a full ROS 2' if others else 'it has none'
        raise BagError(f"'{path}' holds no MCAP file: {reason}")
    for file in files:
        if file.suffixes[-2:] == ['.mcap', '.zstd']:
            raise BagError(
                f"'{file}' is compressed as a whole, which is not read here: call `zstd -d` on it "
                f'and remove {path / FILE_NAME}'
            )
        if file.suffix != '.mcap':
            raise BagError(f"'{file}' is no MCAP file; other storages need a full ROS 2")
        if not file.is_file():
            raise BagError(f"'{file}', named in {path / FILE_NAME}, does not exist")
    return files


def check_storage(storage_id: str) -> None:
    """
    Take 'mcap', and '' for the same.

    :raises BagError: it is another one.
    """
    if storage_id not in ('', 'mcap'):
        raise BagError(
            f"storage_id='{storage_id}': bags are stored as 'mcap' here, other storages need "
            "a full ROS 2; write storage_id='mcap'"
        )


def describe(path: Path) -> BagMetadata:
    """
    Tell what a bag holds from its files alone, whatever its metadata.yaml says.

    :raises BagError: there is no bag, or a file of it is no MCAP file.
    """
    names = find(path)
    files = []
    for name in names:
        with McapFile(name) as file:
            files.append(file)
    bag = _told(files[-1])
    inside = [str(name.relative_to(path)) if path.is_dir() else str(name) for name in names]
    bag.storage_identifier = 'mcap'
    bag.bag_size = sum(name.stat().st_size for name in names)
    bag.relative_file_paths = inside
    bag.files = [_file(file, name) for file, name in zip(files, inside, strict=True)]
    bag.topics_with_message_count = _topics(files)
    bag.message_count = sum(file.statistics.message_count for file in files)
    filled = [file.statistics for file in files if file.statistics.message_count]
    start = min((each.message_start_time for each in filled), default=0)
    end = max((each.message_end_time for each in filled), default=0)
    bag.starting_time, bag.duration = Nanoseconds(start), Nanoseconds(end - start)
    return bag


def _told(file: McapFile) -> BagMetadata:
    """Return what only who recorded the file knew."""
    told = file.rosbag2_record
    bag = BagMetadata()
    with suppress(KeyError, BagError):  # All but custom_data is in the file itself.
        bag = MetadataIo().deserialize_metadata(told['serialized_metadata'])
    bag.ros_distro = told.get('ROS_DISTRO', bag.ros_distro)
    return bag


def _file(file: McapFile, name: str) -> FileInformation:
    of = file.statistics
    start, duration = of.message_start_time, of.message_end_time - of.message_start_time
    return FileInformation(name, Nanoseconds(start), Nanoseconds(duration), of.message_count)


def _topics(files: Sequence[McapFile]) -> list[TopicInformation]:
    found: dict[str, TopicInformation] = {}
    for file in files:
        for channel in file.summary.channels.values():
            if channel.topic not in found:
                schema = file.summary.schemas.get(channel.schema_id)
                topic = TopicMetadata(
                    channel.id,
                    channel.topic,
                    schema.name if schema else '',
                    channel.message_encoding,
                    _profiles(channel.metadata.get('offered_qos_profiles', '')),
                    channel.metadata.get('topic_type_hash', ''),
                )
                found[channel.topic] = TopicInformation(topic, 0)
            count = file.statistics.channel_message_counts.get(channel.id, 0)
            found[channel.topic].message_count += count
    return [found[name] for name in sorted(found)]


def _profiles(text: str) -> list[_qos.QoS]:
    try:
        return _qos.to_rclcpp_qos_vector(text, 9)
    except BagError:
        return []  # The defaults suit every subscription.
