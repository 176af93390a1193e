# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""When a robot does not do as it is told, and when it does well enough."""

from husky_driver.checks.watchdog import Watchdog
from husky_driver.motion import AT_ORIGIN, Command, Odometry
import pytest

AHEAD = Command(0.5, 0.0)


def complaint(last: Odometry, command: Command, *, period_sec: float = 0.1) -> tuple[float, str]:
    """Return when it complains, and why, of steady motion from the origin to a last odometry."""
    watchdog = Watchdog(AT_ORIGIN)
    steps = round(last.time_sec / period_sec)
    for step in range(1, steps + 1):
        part = step / steps
        now = last._replace(
            time_sec=step * period_sec, x_m=part * last.x_m, yaw_rad=part * last.yaw_rad
        )
        if why := watchdog.complaint(now, command):
            return now.time_sec, why
    return last.time_sec, ''


def test_who_stands_for_four_seconds_is_stuck() -> None:
    when, why = complaint(AT_ORIGIN._replace(time_sec=9.0), AHEAD)
    assert when == pytest.approx(4.1)
    assert why.startswith('the robot does not move: told to drive 0.50 m/s and turn 0.00 rad/s')
    assert complaint(AT_ORIGIN._replace(time_sec=9.0), Command(0.0, 0.0))[1] == ''


@pytest.mark.parametrize(
    ('moved', 'stuck'),
    [
        ({'x_m': 0.0195}, True),
        ({'x_m': -0.0205}, False),
        ({'yaw_rad': 0.0295}, True),
        ({'yaw_rad': -0.0305}, False),
    ],
)
def test_two_centimetres_or_two_degrees_are_a_move(moved: dict[str, float], stuck: bool) -> None:
    last = AT_ORIGIN._replace(time_sec=4.1, **moved)
    assert ('does not move' in complaint(last, AHEAD, period_sec=0.05)[1]) is stuck


@pytest.mark.parametrize(('period_sec', 'stuck'), [(0.19, True), (0.21, False)])
def test_a_gap_of_two_tenths_of_a_second_says_nothing(period_sec: float, stuck: bool) -> None:
    last = AT_ORIGIN._replace(time_sec=50 * period_sec)
    assert bool(complaint(last, AHEAD, period_sec=period_sec)[1]) is stuck


@pytest.mark.parametrize(
    ('told_rad_s', 'turns_rad_s', 'slips'),
    [
        (-0.5, -0.195, True),  # it lacks more than six tenths
        (-0.5, -0.205, False),
        (0.31, 0.1, True),
        (0.29, 0.0, False),  # too slow to judge
        (1.0, 2.0, False),  # faster than told
    ],
)
def test_who_turns_too_slowly_for_a_second_slips(
    told_rad_s: float, turns_rad_s: float, slips: bool
) -> None:
    last = Odometry(1.3, 1.0, 0.0, 1.3 * turns_rad_s, 0.5, turns_rad_s)
    when, why = complaint(last, Command(0.5, told_rad_s), period_sec=0.05)
    assert why.startswith('the wheels slip') is slips
    assert not slips or when == pytest.approx(1.05)
