# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a rubric asks of the fields of a message."""

from husky_grader.lab.messages import about, complaint
from husky_grader.rubric.steps import FieldCheck
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32, Float64


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
