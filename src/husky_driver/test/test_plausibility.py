# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import math

from geometry_msgs.msg import Quaternion
from husky_driver.checks.plausibility import no_numbers, no_rotation, OdometryCheck
from husky_driver.motion import Odometry
from hypothesis import given, settings, strategies
import pytest

DRIVING = Odometry(30.0, 5.0, 2.0, 1.0, 0.8, 0.1)


def complaint(*messages: Odometry) -> str:
    """Return the first complaint about messages one after the other."""
    check = OdometryCheck()
    return next(filter(None, map(check.complaint, messages)), '')


def moved(**changes: float) -> Odometry:
    """Return a plausible odometry 20 ms later, with these changes."""
    return DRIVING._replace(**{'time_sec': 30.02, 'x_m': 5.008, **changes})


def test_what_a_husky_does_is_accepted() -> None:
    assert complaint(DRIVING, moved()) == ''
    assert complaint(DRIVING, moved(yaw_rad=1.0 + 0.04)) == ''
    assert complaint(DRIVING._replace(yaw_rad=3.14), moved(yaw_rad=-3.14)) == ''


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf, 4.4e87])
@pytest.mark.parametrize('field', ['x_m', 'y_m', 'yaw_rad', 'speed_m_s', 'yaw_rate_rad_s'])
def test_what_is_no_number_is_named(field: str, value: float) -> None:
    if field == 'yaw_rad' and math.isfinite(value):
        return
    assert complaint(DRIVING, moved(**{field: value})).endswith(
        f'{value:.6g} '
        + {'x_m': 'm', 'y_m': 'm', 'yaw_rad': 'rad'}.get(
            field, 'm/s' if field == 'speed_m_s' else 'rad/s'
        )
    )


@pytest.mark.parametrize(
    ('changes', 'said'),
    [
        ({'x_m': 5.5}, 'it jumps 0.50 m in 0.02 s, from (5.00, 2.00) to (5.50, 2.00)'),
        ({'yaw_rad': 2.0}, 'it jumps by 1.00 rad of yaw in 0.02 s'),
        ({'yaw_rad': 0.0}, 'it jumps by -1.00 rad of yaw in 0.02 s'),
        ({'time_sec': 29.98}, 'goes back from 30.00 s to 29.98 s, which is no reset'),
        ({'time_sec': 0.5, 'speed_m_s': 0.8}, 'which is no reset'),
        ({'time_sec': 12.0, 'speed_m_s': 0.0}, 'which is no reset'),
        ({'time_sec': 0.5, 'speed_m_s': 0.0, 'yaw_rate_rad_s': -0.8}, 'which is no reset'),
    ],
)
def test_what_no_husky_can_do_is_named(changes: dict[str, float], said: str) -> None:
    assert said in complaint(DRIVING, moved(**changes))


@pytest.mark.parametrize('sign', [1, -1])
@pytest.mark.parametrize(
    ('field', 'most', 'more'),
    [
        ('x_m', 1e6, 1.001e6),
        ('y_m', 1e6, 1.001e6),
        ('speed_m_s', 10.0, 10.1),
        ('yaw_rate_rad_s', 20.0, 20.1),
    ],
)
def test_the_most_that_can_be_is_accepted(field: str, most: float, more: float, sign: int) -> None:
    assert complaint(moved(**{field: sign * most})) == ''
    assert complaint(moved(**{field: sign * more})).startswith('its ')


@pytest.mark.parametrize(
    ('possible', 'impossible', 'said'),
    [
        ({'x_m': 5.285}, {'x_m': 5.295}, 'it jumps 0.29 m in 0.02 s'),
        ({'time_sec': 31.0, 'x_m': 7.2}, {'time_sec': 31.0, 'x_m': 7.3}, 'it jumps 2.30 m in 1'),
        ({'yaw_rad': 0.43}, {'yaw_rad': 0.41}, 'it jumps by -0.59 rad'),
        (
            {'time_sec': 30.5, 'yaw_rad': 3.45},
            {'time_sec': 30.5, 'yaw_rad': 3.55},
            'it jumps by 2.55 rad of yaw in 0.50 s',
        ),
        ({'time_sec': 59.9}, {'time_sec': 60.1}, 'its stamp jumps ahead from 30.00 s to 60.10 s'),
        (
            {'time_sec': 1.0, 'speed_m_s': -0.29, 'yaw_rate_rad_s': 0.29},
            {'time_sec': 1.02, 'speed_m_s': -0.29, 'yaw_rate_rad_s': 0.29},
            'which is no reset',
        ),
        (
            {'time_sec': 0.0, 'speed_m_s': 0.29, 'yaw_rate_rad_s': -0.29},
            {'time_sec': 0.0, 'speed_m_s': 0.31, 'yaw_rate_rad_s': -0.29},
            'which is no reset',
        ),
        (
            {'time_sec': 0.0, 'speed_m_s': 0.29},
            {'time_sec': 0.0, 'speed_m_s': 0.29, 'yaw_rate_rad_s': -0.31},
            'which is no reset',
        ),
    ],
)
def test_between_what_can_be_and_what_cannot_is_little(
    possible: dict[str, float], impossible: dict[str, float], said: str
) -> None:
    assert complaint(DRIVING, moved(**possible)) == ''
    assert said in complaint(DRIVING, moved(**impossible))


@pytest.mark.parametrize(('after_sec', 'said'), [(0.09, ''), (0.11, 'its stamp jumps to and fro')])
def test_after_an_early_reset_a_message_or_two_may_be_lost(after_sec: float, said: str) -> None:
    times = (0.0, 0.08, 0.0, after_sec)
    found = complaint(*(Odometry(time, 0.0, 0.0, 0.0, 0.0, 0.0) for time in times))
    assert found[:26] == said


def test_lost_messages_are_no_jump() -> None:
    assert complaint(DRIVING, moved(time_sec=33.0, x_m=8.0, yaw_rad=-2.0)) == ''


def test_a_reset_is_accepted_and_what_follows_it() -> None:
    begun = [Odometry(k * 0.02, 0.0, 0.0, 0.0, 0.0, 0.0) for k in range(2000)]
    assert complaint(DRIVING, *begun) == ''
    assert complaint(begun[20], *begun) == ''


@pytest.mark.parametrize('before', range(1, 60))
def test_a_reset_is_accepted_however_early(before: int) -> None:
    standing = Odometry(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    periods = [*range(before), *range(200)]
    assert complaint(*(standing._replace(time_sec=0.02 * n) for n in periods)) == ''


def test_a_stamp_far_ahead_is_named() -> None:
    said = complaint(DRIVING, moved(time_sec=130.0))
    assert said == 'its stamp jumps ahead from 30.00 s to 130.00 s'


def test_a_stamp_that_returns_after_a_reset_is_named() -> None:
    reset = Odometry(0.02, 0.0, 0.0, 0.0, 0.0, 0.0)
    said = complaint(DRIVING, reset, moved(time_sec=30.04))
    assert said == 'its stamp jumps to and fro between 0.02 s and 30.04 s'


@settings(max_examples=50)
@given(strategies.floats(0.02, 200.0), strategies.integers(1, 4), strategies.integers(1, 4))
def test_two_simulators_at_different_times_are_noticed(
    apart_sec: float, ours: int, theirs: int
) -> None:
    messages = []
    for turn in range(400):
        for number in range(ours):
            now_sec = apart_sec + (turn * ours + number) * 0.02
            messages.append(Odometry(now_sec, 1.0, 0.0, 0.0, 0.0, 0.0))
        for number in range(theirs):
            now_sec = (turn * theirs + number) * 0.02
            messages.append(Odometry(now_sec, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert complaint(*messages) != ''


@pytest.mark.parametrize(
    ('parts', 'length'),
    [
        ((0.0, 0.0, 0.0, 0.0), '0'),
        ((0.0, 0.0, 0.0, 1.11), '1.11'),
        ((0.0, 0.89, 0.0, 0.0), '0.89'),
    ],
)
def test_a_quaternion_that_is_none_is_named(parts: tuple[float, ...], length: str) -> None:
    x, y, z, w = parts
    assert no_rotation(Quaternion(x=x, y=y, z=z, w=w)).endswith(f'its length is {length}, not 1')


def test_a_quaternion_of_no_numbers_is_named() -> None:
    assert 'no rotation' in no_rotation(Quaternion(x=math.nan, y=0.0, z=0.0, w=1.0))
    assert no_rotation(Quaternion(x=0.0, y=0.0, z=0.6, w=0.8)) == ''
    assert no_rotation(Quaternion(x=-1.09, y=0.0, z=0.0, w=0.0)) == ''
    assert no_rotation(Quaternion(x=0.0, y=0.0, z=-0.91, w=0.0)) == ''


def test_no_impact_is_too_hard_but_what_no_sensor_measures() -> None:
    assert no_numbers({'x': 9e4, 'y': -1e5}) == ''
    assert no_numbers({'x': 9e4, 'y': -1.1e5}) == 'its y is -110000'
