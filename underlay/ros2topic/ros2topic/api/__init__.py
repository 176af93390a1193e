# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What verbs of other packages use of `ros2 topic`."""

from __future__ import annotations

import time
from typing import Any

from ros2cli import completion, interfaces
from ros2cli.arguments import positive_float, positive_int
from rtps_graph.names import is_hidden

from ros2topic.qos import (
    add_qos_arguments,
    profile_configure_short_keys,
    qos_profile_from_short_keys,
)

__all__ = [
    'TopicMessagePrototypeCompleter',
    'TopicNameCompleter',
    'TopicTypeCompleter',
    'add_qos_arguments',
    'get_msg_class',
    'get_topic_names',
    'get_topic_names_and_types',
    'message_type_completer',
    'positive_float',
    'positive_int',
    'profile_configure_short_keys',
    'qos_profile_from_short_keys',
]

_POLL_SEC = 0.1


def get_topic_names_and_types(
    *, node: Any, include_hidden_topics: bool = False
) -> list[tuple[str, list[str]]]:
    return [
        (name, types)
        for name, types in node.get_topic_names_and_types()
        if include_hidden_topics or not is_hidden(name)
    ]


def get_topic_names(*, node: Any, include_hidden_topics: bool = False) -> list[str]:
    found = get_topic_names_and_types(node=node, include_hidden_topics=include_hidden_topics)
    return [name for name, _ in found]


def get_msg_class(
    node: Any,
    topic: str,
    blocking: bool = False,
    include_hidden_topics: bool = False,
) -> Any:
    """Return the class of the messages of a topic; None where it does not exist.

    :param blocking: wait for the topic instead.
    :raises RuntimeError: the name is invalid, or the topic has no one type that is installed.
    """
    message_class = _msg_class(node, topic, include_hidden=include_hidden_topics)
    if message_class is None:
        print(f'WARNING: topic [{topic}] does not appear to be published yet')
    while blocking and message_class is None and node.context.ok():
        time.sleep(_POLL_SEC)
        message_class = _msg_class(node, topic, include_hidden=include_hidden_topics)
    return message_class


def _msg_class(node: Any, topic: str, *, include_hidden: bool) -> Any:
    from rclpy.exceptions import InvalidTopicNameException
    from rclpy.expand_topic_name import expand_topic_name
    from rclpy.validate_full_topic_name import validate_full_topic_name
    from rosidl_runtime_py.utilities import get_message

    try:
        name = expand_topic_name(topic, node.get_name(), node.get_namespace())
        validate_full_topic_name(name)
    except (ValueError, InvalidTopicNameException) as error:
        raise RuntimeError(error) from None
    found = get_topic_names_and_types(node=node, include_hidden_topics=include_hidden)
    types = dict(found).get(name)
    if types is None:
        return None
    if len(types) > 1:
        raise RuntimeError(f"topic '{topic}' has more than one type: {', '.join(types)}")
    try:
        with interfaces.unchecked():
            return get_message(types[0])
    except (AttributeError, ModuleNotFoundError, ValueError):
        raise RuntimeError(f"the type '{types[0]}' is not installed") from None


class TopicNameCompleter(completion.NameCompleter):
    def __init__(self, *, include_hidden_topics_key: str | None = None) -> None:
        super().__init__('topic', include_hidden_topics_key)


class TopicTypeCompleter(completion.TypeCompleter):
    def __init__(self, *, topic_name_key: str | None = None) -> None:
        super().__init__('topic', topic_name_key)


class TopicMessagePrototypeCompleter(completion.PrototypeCompleter):
    def __init__(self, *, topic_type_key: str | None = None) -> None:
        super().__init__(topic_type_key)


def message_type_completer(**_: Any) -> list[str]:
    return completion.known_types('topic')
