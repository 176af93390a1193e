# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A file of ROS 2 messages, as rosbag2's storage of MCAP writes it (mcap.dev/spec/registry)."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
import heapq
from pathlib import Path
import re
from typing import Any

from mcap.writer import Writer
from rosidl_runtime_py import get_interface_path
from rosidl_runtime_py.utilities import get_message
import yaml

_NESTED = re.compile(r'(\w+)/(\w+)')
_FOREVER = {'sec': 9223372036, 'nsec': 854775807}  # rosbag2's word for it


@dataclass(frozen=True)
class Topic:
    """
    A topic with all its messages.

    :param messages: times in nanoseconds, in order, each with a serialized message.
    :param latched: whether who comes later still gets the last message.
    """

    name: str
    kind: Any
    messages: Iterable[tuple[int, bytes]]
    latched: bool = False


def write_mcap(path: Path, topics: Sequence[Topic]) -> None:
    """
    Write topics into a new file, their messages in the order of their times.

    :raises OSError: if it cannot be written.
    """
    with path.open('wb') as stream:
        writer = Writer(stream)
        writer.start(profile='ros2', library='husky_grader')
        channels = [_add_channel(writer, topic) for topic in topics]
        for time_ns, channel, data in heapq.merge(*map(_of_channel, topics, channels)):
            writer.add_message(channel, time_ns, data, time_ns)
        writer.finish()


def _of_channel(topic: Topic, channel: int) -> Iterator[tuple[int, int, bytes]]:
    for time_ns, data in topic.messages:
        yield time_ns, channel, data


def _add_channel(writer: Writer, topic: Topic) -> int:
    name = _name_of(topic.kind)
    schema = writer.register_schema(name, 'ros2msg', _definition(topic.kind).encode())
    profiles = yaml.safe_dump([_qos(topic)], sort_keys=False)
    return writer.register_channel(topic.name, 'cdr', schema, {'offered_qos_profiles': profiles})


def _qos(topic: Topic) -> dict[str, Any]:
    return {
        'history': 'keep_last',
        'depth': 1 if topic.latched else 10,
        'reliability': 'reliable',
        'durability': 'transient_local' if topic.latched else 'volatile',
        'deadline': dict(_FOREVER),
        'lifespan': dict(_FOREVER),
        'liveliness': 'automatic',
        'liveliness_lease_duration': dict(_FOREVER),
        'avoid_ros_namespace_conventions': False,
    }


def _name_of(kind: Any) -> str:
    return f'{kind.__module__.partition(".")[0]}/msg/{kind.__name__}'


def _definition(kind: Any) -> str:
    """Return the text of a definition, and behind it those of all messages inside, each once."""
    parts, kinds = [_text(kind)], _inside(kind)
    for each in kinds:
        parts.append(f'{"=" * 80}\nMSG: {_name_of(each).replace("/msg/", "/")}\n{_text(each)}')
        kinds += [inner for inner in _inside(each) if inner not in kinds]
    return '\n'.join(parts)


def _text(kind: Any) -> str:
    return Path(get_interface_path(_name_of(kind))).read_text(encoding='utf-8')


def _inside(kind: Any) -> list[Any]:
    """Return the classes of the messages that are fields, or items of fields, of one."""
    types = kind.get_fields_and_field_types().values()
    found = [_NESTED.search(field) for field in types]
    return list(dict.fromkeys(get_message(f'{at[1]}/msg/{at[2]}') for at in found if at))
