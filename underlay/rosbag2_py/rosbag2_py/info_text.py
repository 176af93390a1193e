# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `ros2 bag info` says of a bag."""

from __future__ import annotations

from datetime import datetime
import math
from typing import TYPE_CHECKING

from rosbag2_py._metadata import BagMetadata, TopicInformation

if TYPE_CHECKING:
    from rosbag2_py.service_calls import Calls

_INDENT = '\n' + ' ' * 19
_EVENTS = '/_service_event'


def describe(bag: BagMetadata, calls: list[Calls] | None = None) -> str:
    """Describe a bag; with the calls of its services in the place of their events."""
    start_ns, duration_ns = bag._starting_time_ns, bag._duration_ns
    services = services_of(bag)
    topics = [each for each in bag.topics_with_message_count if not is_service(each)]
    counts = [f'Event Count: {each.message_count}' for each in services]
    if calls is not None:
        counts = [
            f'Request Count: {len(each.requests)} | Response Count: {len(each.responses)}'
            for each in calls
        ]
    messages = bag.message_count - sum(each.message_count for each in services)
    return (
        f'\nFiles:             {_INDENT.join(bag.relative_file_paths)}\n'
        f'Bag size:          {_size(bag.bag_size)}\n'
        f'Storage id:        {bag.storage_identifier}\n'
        f'ROS Distro:        {bag.ros_distro or "unknown"}\n'
        f'Duration:          {_seconds(duration_ns)}s\n'
        f'Start:             {_time(start_ns)}\n'
        f'End:               {_time(start_ns + duration_ns)}\n'
        f'Messages:          {messages}\n'
        f'Topic information: {_INDENT.join(map(_topic, topics))}\n'
        f'Service:           {len(services)}\n'
        f'Service information: {f"{_INDENT}  ".join(map(_service, services, counts))}\n'
    )


def services_of(bag: BagMetadata) -> list[TopicInformation]:
    return [each for each in bag.topics_with_message_count if is_service(each)]


def is_service(each: TopicInformation) -> bool:
    """Return whether it is the topic of the events of a service."""
    topic = each.topic_metadata
    return topic.name.endswith(_EVENTS) and topic.type.endswith('_Event')


def _topic(each: TopicInformation) -> str:
    topic = each.topic_metadata
    return (
        f'Topic: {topic.name} | Type: {topic.type} | Count: {each.message_count} | '
        f'Serialization Format: {topic.serialization_format}'
    )


def _service(each: TopicInformation, count: str) -> str:
    topic = each.topic_metadata
    return (
        f'Service: {topic.name.removesuffix(_EVENTS)} | Type: {topic.type.removesuffix("_Event")} '
        f'| {count} | Serialization Format: {topic.serialization_format}'
    )


def _size(number: int) -> str:
    if number < 1024:
        return f'{number} B'
    exponent = min(int(math.log2(number)) // 10, 4)
    return f'{number / 1024**exponent:.1f} {("KiB", "MiB", "GiB", "TiB")[exponent - 1]}'


def _seconds(nanoseconds: int) -> str:
    return f'{nanoseconds // 10**9}.{nanoseconds % 10**9:09}'


def _time(nanoseconds: int) -> str:
    moment = datetime.fromtimestamp(nanoseconds // 10**9)
    return f'{moment:%b %e %Y %H:%M:%S}.{nanoseconds % 10**9:09} ({_seconds(nanoseconds)})'
