# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The classes that options and descriptions of bags are made of."""

from rosbag2_py._metadata import (
    BagMetadata,
    FileInformation,
    MessageDefinition,
    TopicInformation,
    TopicMetadata,
)
from rosbag2_py._metadata_io import MetadataIo
from rosbag2_py._options import (
    ConverterOptions,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
)
from rosbag2_py._qos import (
    convert_rclcpp_qos_to_rclpy_qos,
    Duration,
    QoS,
    rmw_qos_durability_policy_t,
    rmw_qos_history_policy_t,
    rmw_qos_liveliness_policy_t,
    rmw_qos_reliability_policy_t,
    to_rclcpp_qos_vector,
)
from rosbag2_py.storages import DEFAULT_ID

__all__ = [
    'BagMetadata',
    'ConverterOptions',
    'Duration',
    'FileInformation',
    'MessageDefinition',
    'MetadataIo',
    'QoS',
    'ReadOrder',
    'ReadOrderSortBy',
    'StorageFilter',
    'StorageOptions',
    'TopicInformation',
    'TopicMetadata',
    'convert_rclcpp_qos_to_rclpy_qos',
    'get_default_storage_id',
    'rmw_qos_durability_policy_t',
    'rmw_qos_history_policy_t',
    'rmw_qos_liveliness_policy_t',
    'rmw_qos_reliability_policy_t',
    'to_rclcpp_qos_vector',
]


def get_default_storage_id() -> str:
    return DEFAULT_ID
