# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""ROS names and types, and how DDS spells them (design.ros2.org, topic and service names)."""

from __future__ import annotations

import re

# Prefixes by which rmw tells what a DDS topic is for.
TOPIC, REQUEST, REPLY = 'rt', 'rq', 'rr'
_SUFFIXES = {TOPIC: '', REQUEST: 'Request', REPLY: 'Reply'}
# The node of a command is called this and the number of its process.
COMMAND_NODE = '_ros2cli_'
_TYPE = re.compile(r'(?P<package>\w+)::(?P<kind>msg|srv|action)::dds_::(?P<name>\w+?)_')


def is_hidden(name: str) -> bool:
    """Tell whether a part of a topic, service or node name begins with an underscore."""
    return any(part.startswith('_') for part in name.split('/') if part)


def ros_topic(dds_topic: str) -> tuple[str, str]:
    """Split a DDS topic into its ROS prefix ('' for none) and the ROS name."""
    prefix, _, rest = dds_topic.partition('/')
    if prefix not in _SUFFIXES:
        return '', dds_topic
    return prefix, '/' + rest.removesuffix(_SUFFIXES[prefix])


def ros_type(dds_type: str) -> str:
    """Turn 'std_msgs::msg::dds_::String_' into 'std_msgs/msg/String'."""
    match = _TYPE.fullmatch(dds_type)
    return '/'.join(match.group('package', 'kind', 'name')) if match else dds_type


def service_type(dds_type: str) -> str:
    """Turn the DDS type of a request or reply into the type of the service."""
    name = ros_type(dds_type)
    for suffix in ('_Request', '_Response'):
        name = name.removesuffix(suffix)
    return name


def expand(name: str) -> str:
    """Return the full name of a topic that was given without its leading slash."""
    return name if name.startswith('/') else '/' + name


def full_node_name(namespace: str, name: str) -> str:
    return f'{namespace.rstrip("/")}/{name}'
