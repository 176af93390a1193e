# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a rubric asks of the fields of a message."""

from husky_grader.lab.messages import about, complaint
from husky_grader.rubric.forms import Form, with_token
from husky_grader.rubric.interfaces import filled
from husky_grader.rubric.steps import FieldCheck
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool, Float32, Float64, Header, Int8, String


@pytest.mark.parametrize(
    'check',
    [
        FieldCheck(field='ranges', equals=0.1),
        FieldCheck(field='ranges', most=0.1),
        FieldCheck(field='range_max', least=0.7),  # in 32 bits it is a little less
    ],
)
def test_a_number_of_32_bits_is_what_the_rubric_says(check: FieldCheck) -> None:
    sent = serialize_message(LaserScan(ranges=[0.1, 0.1], range_max=0.7))
    assert complaint(deserialize_message(sent, LaserScan), [check]) == ''


def test_another_number_of_32_bits_is_told() -> None:
    heard = deserialize_message(serialize_message(Float32(data=0.11)), Float32)
    wrong = 'data is 0.11; the lab asks for 0.1'
    assert complaint(heard, [FieldCheck(field='data', equals=0.1)]) == wrong
    most = complaint(heard, [FieldCheck(field='data', most=0.1)])
    assert most == f'{wrong} or less'
    text = complaint(String(data='Hi'), [FieldCheck(field='data', form=Form('hi <number>'))])
    assert text.endswith('; the lab asks for "hi <number>"')


@pytest.mark.parametrize(
    ('sent', 'check', 'wrong'),
    [
        (0.1 + 0.2, FieldCheck(field='data', equals=0.3), '0.30000000000000004; the lab asks'),
        (0.4999, FieldCheck(field='data', least=0.5), '0.4999; the lab asks for 0.5 or more'),
    ],
)
def test_no_number_is_told_as_what_is_asked_for(
    sent: float, check: FieldCheck, wrong: str
) -> None:
    assert complaint(Float64(data=sent), [check]).startswith(f'data is {wrong}')


@pytest.mark.parametrize(
    ('rate_hz', 'told'), [(4.93, '5'), (0.51, '0.5'), (198.0, '200'), (9.6, '10'), (0.0, '0')]
)
def test_a_rate_is_told_in_round_numbers(rate_hz: float, told: str) -> None:
    assert about(rate_hz) == told


def test_a_message_is_filled_with_what_the_rubric_says() -> None:
    header = filled(Header(), with_token({'frame_id': 'f{token}', 'stamp': {'sec': 3}}, '7'))
    assert (header.frame_id, header.stamp.sec) == ('f7', 3)
    assert filled(LaserScan(), with_token({'ranges': [1, 2.5]}, '7')).ranges.tolist() == [1, 2.5]
    assert filled(Bool(), {'data': True}).data is True
    assert with_token({'name': ['{token}', 1.5, None]}, '7') == {'name': ['7', 1.5, None]}


@pytest.mark.parametrize(
    ('message', 'values', 'told'),
    [
        (String(), {'dat': 'a'}, 'dat'),
        (Int8(), {'data': 'many'}, 'many'),
        (Int8(), {'data': 300}, '-128'),
        (Float32(), {'data': {'a': 1}}, ''),
    ],
)
def test_what_a_message_cannot_hold_is_told_in_a_line(
    message: object, values: dict[str, object], told: str
) -> None:
    with pytest.raises(ValueError, match=rf'\A.*{told}.*\Z'):
        filled(message, values)
