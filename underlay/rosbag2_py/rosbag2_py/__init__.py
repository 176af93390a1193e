# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Bags from a program: write, read, describe. Upstream's names, in Python, on MCAP and sqlite3."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from rosbag2_py._storage import (
    BagMetadata,
    convert_rclcpp_qos_to_rclpy_qos,
    ConverterOptions,
    FileInformation,
    get_default_storage_id,
    MessageDefinition,
    MetadataIo,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
    to_rclcpp_qos_vector,
    TopicInformation,
    TopicMetadata,
)

if TYPE_CHECKING:
    from rosbag2_py._compression_options import (
        compression_mode_from_string,
        compression_mode_to_string,
        CompressionMode,
        CompressionOptions,
    )
    from rosbag2_py._info import Info
    from rosbag2_py._message_definitions import LocalMessageDefinitionSource
    from rosbag2_py._reader import (
        get_registered_readers,
        SequentialCompressionReader,
        SequentialReader,
    )
    from rosbag2_py._reindexer import Reindexer
    from rosbag2_py._rewrite import bag_rewrite
    from rosbag2_py._writer import (
        get_registered_compressors,
        get_registered_serializers,
        get_registered_writers,
        SequentialCompressionWriter,
        SequentialWriter,
    )

__all__ = [
    'BagMetadata',
    'CompressionMode',
    'CompressionOptions',
    'ConverterOptions',
    'FileInformation',
    'Info',
    'LocalMessageDefinitionSource',
    'MessageDefinition',
    'MetadataIo',
    'ReadOrder',
    'ReadOrderSortBy',
    'Reindexer',
    'SequentialCompressionReader',
    'SequentialCompressionWriter',
    'SequentialReader',
    'SequentialWriter',
    'StorageFilter',
    'StorageOptions',
    'TopicInformation',
    'TopicMetadata',
    'bag_rewrite',
    'compression_mode_from_string',
    'compression_mode_to_string',
    'convert_rclcpp_qos_to_rclpy_qos',
    'get_default_storage_id',
    'get_registered_compressors',
    'get_registered_readers',
    'get_registered_serializers',
    'get_registered_writers',
    'to_rclcpp_qos_vector',
]

# Loaded when they are asked for: who reads needs no writer.
_MODULES = {
    'Info': '_info',
    'LocalMessageDefinitionSource': '_message_definitions',
    'Reindexer': '_reindexer',
    'bag_rewrite': '_rewrite',
    **dict.fromkeys(
        (
            'CompressionMode',
            'CompressionOptions',
            'compression_mode_from_string',
            'compression_mode_to_string',
        ),
        '_compression_options',
    ),
    **dict.fromkeys(
        ('SequentialCompressionReader', 'SequentialReader', 'get_registered_readers'), '_reader'
    ),
    **dict.fromkeys(
        (
            'SequentialCompressionWriter',
            'SequentialWriter',
            'get_registered_compressors',
            'get_registered_serializers',
            'get_registered_writers',
        ),
        '_writer',
    ),
}
_PLAY = '`ros2 bag play` plays; in a program, read with SequentialReader and publish'
_RECORD = '`ros2 bag record` records; in a program, subscribe and write with SequentialWriter'
_LEFT_OUT = {
    **dict.fromkeys(('Player', 'PlayOptions', 'ServiceRequestsSource'), _PLAY),
    **dict.fromkeys(('Recorder', 'RecordOptions'), _RECORD),
}


def __getattr__(name: str) -> object:
    if name in _MODULES:
        return getattr(importlib.import_module(f'rosbag2_py.{_MODULES[name]}'), name)
    if name in _MODULES.values():
        return importlib.import_module(f'rosbag2_py.{name}')
    if name in _LEFT_OUT:
        raise ImportError(f'rosbag2_py.{name} needs a full ROS 2; here {_LEFT_OUT[name]}')
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
