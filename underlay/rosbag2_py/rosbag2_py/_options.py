# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is asked of a writer or a reader."""

from __future__ import annotations

import enum

from rosbag2_py._fields import Field, many, one, text, texts_by_text, whole


class StorageOptions:
    """
    Where a bag is and how it is stored.

    :param uri: the folder of the bag; to read, one of its files will do.
    :param storage_id: 'mcap' or 'sqlite3'; '' is found out to read, and 'mcap' to write.
    :param max_bagfile_size: bytes after which a writer begins a new file; 0 for never.
    :param max_bagfile_duration: seconds after which a writer begins a new file; 0 for never.
    :param max_cache_size: bytes of messages that are kept with snapshot_mode; of no effect
        without it, for a writer has a buffer of its own.
    :param storage_preset_profile: for MCAP 'none', 'fastwrite', 'zstd_fast' or 'zstd_small', for
        sqlite3 'none' or 'resilient'.
    :param start_time_ns: messages from before are not written; -1 for no limit.
    :param end_time_ns: messages from after are not written; -1 for no limit.
    :param custom_data: kept in metadata.yaml.
    """

    uri = Field(text)
    storage_id = Field(text)
    max_bagfile_size = Field(whole(64))
    max_bagfile_duration = Field(whole(64))
    max_cache_size = Field(whole(64))
    storage_preset_profile = Field(text)
    storage_config_uri = Field(text)
    snapshot_mode = Field(bool)
    start_time_ns = Field(whole(64, signed=True))
    end_time_ns = Field(whole(64, signed=True))
    custom_data = Field(texts_by_text)

    def __init__(
        self,
        uri: str,
        storage_id: str = '',
        max_bagfile_size: int = 0,
        max_bagfile_duration: int = 0,
        max_cache_size: int = 0,
        storage_preset_profile: str = '',
        storage_config_uri: str = '',
        snapshot_mode: bool = False,
        start_time_ns: int = -1,
        end_time_ns: int = -1,
        custom_data: dict[str, str] = {},  # noqa: B006
    ) -> None:
        self.uri = uri
        self.storage_id = storage_id
        self.max_bagfile_size = max_bagfile_size
        self.max_bagfile_duration = max_bagfile_duration
        self.max_cache_size = max_cache_size
        self.storage_preset_profile = storage_preset_profile
        self.storage_config_uri = storage_config_uri
        self.snapshot_mode = snapshot_mode
        self.start_time_ns = start_time_ns
        self.end_time_ns = end_time_ns
        self.custom_data = custom_data


class ConverterOptions:
    """The encodings of what is given and of what is kept; here they are always the same."""

    input_serialization_format = Field(text)
    output_serialization_format = Field(text)

    def __init__(
        self, input_serialization_format: str = '', output_serialization_format: str = ''
    ) -> None:
        self.input_serialization_format = input_serialization_format
        self.output_serialization_format = output_serialization_format


class StorageFilter:
    """
    Which topics a reader reads: what is not excluded and, if anything is named, is named.

    Expressions must match a whole name. Topics of service events have their own lists.
    """

    topics = Field(many(text))
    services_events = Field(many(text))
    regex = Field(text)
    exclude_topics = Field(many(text))
    exclude_service_events = Field(many(text))
    regex_to_exclude = Field(text)

    def __init__(
        self,
        topics: list[str] = [],  # noqa: B006
        services_events: list[str] = [],  # noqa: B006
        regex: str = '',
        exclude_topics: list[str] = [],  # noqa: B006
        exclude_service_events: list[str] = [],  # noqa: B006
        regex_to_exclude: str = '',
    ) -> None:
        self.topics = topics
        self.services_events = services_events
        self.regex = regex
        self.exclude_topics = exclude_topics
        self.exclude_service_events = exclude_service_events
        self.regex_to_exclude = regex_to_exclude


class ReadOrderSortBy(enum.Enum):
    """By what a reader sorts the messages of a file."""

    ReceivedTimestamp = 0
    PublishedTimestamp = 1
    File = 2

    def __int__(self) -> int:
        return self.value

    __index__ = __int__


class ReadOrder:
    """The order in which a reader gives the messages of a file."""

    sort_by = Field(one(ReadOrderSortBy))
    reverse = Field(bool)

    def __init__(
        self,
        sort_by: ReadOrderSortBy = ReadOrderSortBy.ReceivedTimestamp,
        reverse: bool = False,
    ) -> None:
        self.sort_by = sort_by
        self.reverse = reverse
