# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a bag holds."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

from rosbag2_py._fields import Field, many, nanoseconds, one, text, texts_by_text, whole
from rosbag2_py._qos import QoS

VERSION = 9
"""The version of metadata.yaml that Jazzy writes."""


class _Zero:
    """No time at all, without rclpy, which takes longer to import than all else here."""

    nanoseconds = 0


class MessageDefinition:
    """The text that defines a message, and those of all that it contains."""

    topic_type = Field(text)
    encoding = Field(text)
    encoded_message_definition = Field(text)
    type_hash = Field(text)

    def __init__(
        self, topic_type: str, encoding: str, encoded_message_definition: str, type_hash: str
    ) -> None:
        self.topic_type = topic_type
        self.encoding = encoding
        self.encoded_message_definition = encoded_message_definition
        self.type_hash = type_hash


class TopicMetadata:
    """
    A topic of a bag.

    :param id: a number that the storage gives; writers take no notice of it.
    :param type: as 'std_msgs/msg/String'.
    :param serialization_format: 'cdr' for messages of ROS 2.
    :param type_description_hash: 'RIHS01_...', or '' where it is not known.
    """

    id = Field(whole(16))
    name = Field(text)
    type = Field(text)
    serialization_format = Field(text)
    offered_qos_profiles = Field(many(one(QoS)))
    type_description_hash = Field(text)

    def __init__(
        self,
        id: int,  # noqa: A002
        name: str,
        type: str,  # noqa: A002
        serialization_format: str,
        offered_qos_profiles: list[QoS] = [],  # noqa: B006
        type_description_hash: str = '',
    ) -> None:
        self.id = id
        self.name = name
        self.type = type
        self.serialization_format = serialization_format
        self.offered_qos_profiles = offered_qos_profiles
        self.type_description_hash = type_description_hash

    def equals(self, other: TopicMetadata) -> bool:
        """Compare all but the qualities of service."""
        names = ('id', 'name', 'type', 'serialization_format', 'type_description_hash')
        return all(getattr(self, name) == getattr(other, name) for name in names)


class TopicInformation:
    """A topic of a bag, and how many messages it has."""

    topic_metadata = Field(one(TopicMetadata))
    message_count = Field(whole(64))

    def __init__(self, topic_metadata: TopicMetadata, message_count: int) -> None:
        self.topic_metadata = topic_metadata
        self.message_count = message_count


class _Begun:
    """What begins with a message."""

    @property
    def starting_time(self) -> Any:
        """The time of the first message, an rclpy.time.Time."""
        from rclpy.time import Time

        return Time(nanoseconds=self._starting_time_ns)

    @starting_time.setter
    def starting_time(self, value: Any) -> None:
        self._starting_time_ns = nanoseconds(value)


class FileInformation(_Begun):
    """A file of a bag; its duration reads as a timedelta, as upstream's does."""

    path = Field(text)
    message_count = Field(whole(64))

    def __init__(self, path: str, starting_time: Any, duration: Any, message_count: int) -> None:
        self.path = path
        self.starting_time = starting_time
        self._duration_ns = nanoseconds(duration)
        self.message_count = message_count

    @property
    def duration(self) -> timedelta:
        """The time from the first message to the last."""
        return timedelta(microseconds=self._duration_ns // 1000)

    @duration.setter
    def duration(self, value: timedelta) -> None:
        self._duration_ns = one(timedelta)(value) // timedelta(microseconds=1) * 1000


class BagMetadata(_Begun):
    """What metadata.yaml says of a bag."""

    version = Field(whole(32, signed=True))
    bag_size = Field(whole(64))
    storage_identifier = Field(text)
    relative_file_paths = Field(many(text))
    files = Field(many(one(FileInformation)))
    message_count = Field(whole(64))
    topics_with_message_count = Field(many(one(TopicInformation)))
    compression_format = Field(text)
    compression_mode = Field(text)
    custom_data = Field(texts_by_text)
    ros_distro = Field(text)

    def __init__(
        self,
        version: int = VERSION,
        bag_size: int = 0,
        storage_identifier: str = '',
        relative_file_paths: list[str] = [],  # noqa: B006
        files: list[FileInformation] = [],  # noqa: B006
        duration: Any = _Zero,
        starting_time: Any = _Zero,
        message_count: int = 0,
        topics_with_message_count: list[TopicInformation] = [],  # noqa: B006
        compression_format: str = '',
        compression_mode: str = '',
        custom_data: dict[str, str] = {},  # noqa: B006
        ros_distro: str = '',
    ) -> None:
        self.version = version
        self.bag_size = bag_size
        self.storage_identifier = storage_identifier
        self.relative_file_paths = relative_file_paths
        self.files = files
        self.duration = duration
        self.starting_time = starting_time
        self.message_count = message_count
        self.topics_with_message_count = topics_with_message_count
        self.compression_format = compression_format
        self.compression_mode = compression_mode
        self.custom_data = custom_data
        self.ros_distro = ros_distro

    @property
    def duration(self) -> Any:
        """The time from the first message to the last, an rclpy.duration.Duration."""
        from rclpy.duration import Duration

        return Duration(nanoseconds=self._duration_ns)

    @duration.setter
    def duration(self, value: Any) -> None:
        self._duration_ns = nanoseconds(value)

    def __repr__(self) -> str:
        from rosbag2_py.info_text import describe

        return describe(self)
