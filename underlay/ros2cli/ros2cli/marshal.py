# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Answers of rclpy in what XML-RPC can carry, and back."""

from __future__ import annotations

import enum
from typing import Any

from rclpy.duration import Duration
from rclpy.qos import QoSProfile
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rclpy.type_hash import TypeHash


def plain(value: Any) -> Any:
    """Turn an answer into what XML-RPC can carry; see `endpoint_info`."""
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    if isinstance(value, enum.IntEnum):
        return int(value)
    if isinstance(value, Duration):
        return str(value.nanoseconds)  # XML-RPC's numbers have 32 bits
    if isinstance(value, (QoSProfile, TopicEndpointInfo, TypeHash)):
        return {slot[1:]: plain(getattr(value, slot)) for slot in value.__slots__}
    return value


def endpoint_info(values: dict[str, Any]) -> Any:
    """Make an rclpy TopicEndpointInfo of what `plain` has made of one."""
    qos = {
        name: Duration(nanoseconds=int(value)) if isinstance(value, str) else value
        for name, value in values['qos_profile'].items()
    }
    type_hash = values['topic_type_hash']
    return TopicEndpointInfo(
        **{
            **values,
            'qos_profile': QoSProfile(**qos),
            'topic_type_hash': TypeHash(type_hash['version'], type_hash['value'].data),
        }
    )
