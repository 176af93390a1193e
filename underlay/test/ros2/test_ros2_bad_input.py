# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whatever a person types, the answer is a message or one clear line, never a traceback."""

from __future__ import annotations

from collections.abc import Callable
import random
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from ros2cli import interfaces
from ros2cli.errors import CommandError
from ros2launch import api
from ros2param import params

MESSAGES = (
    'std_msgs/msg/String',
    'std_msgs/msg/Int8',
    'std_msgs/msg/UInt64',
    'std_msgs/msg/Float32',
    'std_msgs/msg/Bool',
    'std_msgs/msg/ByteMultiArray',
    'geometry_msgs/msg/Twist',
    'sensor_msgs/msg/Imu',
    'sensor_msgs/msg/LaserScan',
    'sensor_msgs/msg/JointState',
    'nav_msgs/msg/Odometry',
    'diagnostic_msgs/msg/DiagnosticArray',
    'rcl_interfaces/msg/ParameterEvent',
)
_scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**70), 2**70),
    st.floats(),
    st.text(max_size=8),
    st.sampled_from(['now', 'auto', '1e3', '0x10', '~', '.nan', '-.inf', 'yes', '\0']),
)
_values = st.recursive(
    _scalars,
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(['data', 'header', 'x', 'linear', 'name', 'stamp', 'status', 'level']),
            inner,
            max_size=3,
        )
    ),
    max_leaves=8,
)


def _refusal(function: Callable[[Any], Any], argument: Any) -> tuple[str | None, Any]:
    """Return what a function refuses with, or what it returns."""
    try:
        return None, function(argument)
    except CommandError as error:
        return str(error), None


@settings(max_examples=600)
@given(st.sampled_from(MESSAGES), _values, st.integers(0, 2**32))
def test_a_message_is_filled_and_sent_or_refused(name: str, value: Any, seed: int) -> None:
    message_class = interfaces.message(name)
    msg = message_class()
    fields = list(msg.get_fields_and_field_types())
    values = value if isinstance(value, dict) else {random.Random(seed).choice(fields): value}
    try:
        interfaces.populate(msg, values, expand_header_auto=True, expand_time_now=True)
    except CommandError:
        return
    # The middleware checks nothing: what was accepted must survive it.
    assert repr(deserialize_message(serialize_message(msg), message_class)) is not None


@settings(max_examples=300)
@given(st.text(alphabet='{}[]:,"\'&*!|>%@`-# \n\tabx019.~', max_size=30) | st.text(max_size=30))
def test_any_text_is_yaml_or_refused(text: str) -> None:
    refusal, values = _refusal(interfaces.yaml_mapping, text)
    assert isinstance(values, dict) or (refusal and '\n' not in refusal)


@settings(max_examples=300)
@given(st.text(max_size=20) | _values.map(str))
def test_any_text_is_a_parameter_value_or_refused(text: str) -> None:
    try:
        value = params.from_text(text)
    except CommandError:
        return
    assert repr(deserialize_message(serialize_message(value), type(value))) is not None


@settings(max_examples=100)
@given(st.lists(st.text(max_size=10), max_size=4))
def test_any_words_are_launch_arguments_or_refused(words: list[str]) -> None:
    refusal, parsed = _refusal(api.parse_launch_arguments, words)
    if refusal is not None:
        assert "expected format '<name>:=<value>'" in refusal
    else:
        assert all(isinstance(value, str) for _, value in parsed)


@pytest.mark.parametrize(
    'words',
    [
        ('topic', 'pub', '-t', '1', '-w', '0', '/x', 'std_msgs/msg/String', '{data: \udcff}'),
        ('topic', 'pub', '-t', '1', '-w', '0', '/x', 'std_msgs/msg/String', '? [a]: b'),
        ('topic', 'pub', '-t', '1', '-w', '0', '/x', '../../etc', '{}'),
        ('topic', 'pub', '-t', '1', '-w', '0', '', 'std_msgs/msg/String'),
        ('topic', 'pub', '-t', '1', '-w', '0', '/x', 'os/path/join', '{}'),
        ('topic', 'pub', '-t', '1', '-w', '0', '-n', 'my node', '/x', 'std_msgs/msg/Empty'),
        ('topic', 'pub', '--qos-depth', '-3', '/x', 'std_msgs/msg/Empty'),
        ('topic', 'echo', '~', 'std_msgs/msg/String'),
        ('service', 'call', '/a b', 'std_srvs/srv/Empty'),
        ('action', 'send_goal', '/a', 'std_msgs/msg/String'),
        ('interface', 'show', '///'),
        ('interface', 'proto', 'a/b/c'),
        ('param', 'set', '/nobody', 'a', '[1, b]'),
        ('pkg', 'prefix', '../..'),
        ('run', '../..', 'x'),
        ('launch', '/dev/null'),
        ('node', 'info', ''),
    ],
)
@pytest.mark.usefixtures('domain')
def test_odd_words_are_refused_in_few_lines(
    ros2: Callable[..., Any], words: tuple[str, ...]
) -> None:
    answer = ros2(*words)
    assert answer.status in (1, 2), answer
    assert 0 < len(answer.err.splitlines()[-1]) < 500
    assert 'ROS2CLI_TRACEBACK' not in answer.err, 'an unexpected error'


@pytest.mark.parametrize(
    ('words', 'told'),
    [
        (('action', 'send_goal', '/a', 'example_interfaces/action/Fibonacci', '{order: x}'),
         "Failed to populate message fields: order: 'x' is refused"),
        (('service', 'call', '/a', 'std_srvs/srv/SetBool', '{data: x}'),
         "Failed to populate field: data: 'x' is refused"),
    ],
)  # fmt: skip
def test_a_value_that_does_not_fit_is_told_as_upstream(
    ros2: Callable[..., Any], words: tuple[str, ...], told: str
) -> None:
    answer = ros2(*words)
    assert (answer.status, answer.err.startswith(told)) == (1, True), answer
