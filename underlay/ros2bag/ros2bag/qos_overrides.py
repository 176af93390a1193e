# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Qualities of service that a YAML file sets for some topics, in place of those found out."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from rclpy.duration import Duration
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from ros2cli.errors import UsageError
from rosbag2_py import yaml_files
from rosbag2_py.errors import BagError
from rtps_graph import names

DEFAULT_DEPTH = 1000
"""How many messages are kept where nothing says otherwise."""
_OPTION = '--qos-profile-overrides-path'
_POLICIES = {
    'history': HistoryPolicy,
    'reliability': ReliabilityPolicy,
    'durability': DurabilityPolicy,
    'liveliness': LivelinessPolicy,
}
_DURATIONS = ('deadline', 'lifespan', 'liveliness_lease_duration')
_DEPTH, _AVOID = 'depth', 'avoid_ros_namespace_conventions'
_LARGEST = 2**31 - 1  # rclpy takes no larger depth
_KEYS = (*_POLICIES, _DEPTH, *_DURATIONS, _AVOID)


def add_argument(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        _OPTION,
        type=Path,
        metavar='FILE',
        help=f'YAML with the quality of service of some topics: for each a dictionary of '
        f'{", ".join(_KEYS)}',
    )


def read(path: Path | None) -> dict[str, QoSProfile]:
    """
    Return the profiles that such a file sets, by the full names of their topics.

    What it does not say of a topic is rclpy's default, and DEFAULT_DEPTH.

    :raises UsageError: the file cannot be read, or something in it is not understood.
    """
    if path is None:
        return {}
    try:
        content = yaml_files.read(path)
    except BagError as error:
        raise UsageError(f'{_OPTION} {error}') from None
    if not isinstance(content, dict):
        raise UsageError(f"{_OPTION} '{path}' names no topic: write /topic: {{depth: 10}}")
    profiles = {}
    for topic, values in content.items():
        try:
            profiles[names.expand(str(topic))] = _profile(values)
        except ValueError as error:
            raise UsageError(f"{_OPTION} '{path}': {topic}: {error}") from None
    return profiles


def _profile(values: Any) -> QoSProfile:
    if not isinstance(values, dict):
        raise ValueError(f'{values!r} is no dictionary of {", ".join(_KEYS)}')
    found = {_DEPTH: DEFAULT_DEPTH, **{key: _value(key, each) for key, each in values.items()}}
    history = found.setdefault('history', HistoryPolicy.KEEP_LAST)
    if found[_DEPTH] == 0 and history == HistoryPolicy.KEEP_LAST:
        raise ValueError('depth: 0 keeps no message; write 1 or more, or history: keep_all')
    return QoSProfile(**found)


def _value(key: Any, value: Any) -> Any:
    if key in _POLICIES:
        return _policy(key, value)
    if key in _DURATIONS:
        return _duration(key, value)
    if key == _DEPTH:
        return _whole(key, value)
    if key == _AVOID:
        if not isinstance(value, bool):
            raise ValueError(f'{key}: {value!r} must be true or false')
        return value
    raise ValueError(f'there is no {key}; there are {", ".join(_KEYS)}')


def _policy(key: str, value: Any) -> Any:
    policy = _POLICIES[key]
    # Upstream takes 'unknown' as well, with which no middleware makes a publisher.
    allowed = [each for each in policy.short_keys() if each != 'unknown']
    if value not in allowed:
        raise ValueError(f'{key}: {value!r} must be one of {", ".join(allowed)}')
    return policy.get_from_short_key(value)


def _duration(key: str, value: Any) -> Duration:
    if not value:  # without end, as in upstream's
        return Duration()
    if not (isinstance(value, dict) and set(value) == {'sec', 'nsec'}):
        raise ValueError(f'{key}: {value!r} must have both, as {{sec: 1, nsec: 0}}')
    sec, nsec = (_whole(f'{key}: {part}', value[part]) for part in ('sec', 'nsec'))
    return Duration(seconds=sec, nanoseconds=nsec)


def _whole(key: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= _LARGEST:
        raise ValueError(f'{key}: {value!r} must be a whole number from 0 to {_LARGEST}')
    return value
