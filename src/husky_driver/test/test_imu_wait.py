# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which odometry waits for readings of the IMU, and for how long."""

from husky_driver.ros import imu_wait
from husky_driver.ros.imu_wait import ImuWait
import pytest

TICK_SEC = 0.125


@pytest.fixture
def wait() -> ImuWait:
    return ImuWait(TICK_SEC)


def pass_time(wait: ImuWait, duration_sec: float) -> None:
    for _ in range(int(duration_sec / TICK_SEC)):
        wait.tick()


def test_the_first_odometry_waits_for_the_reading_of_its_moment(wait: ImuWait) -> None:
    assert wait.has_to_wait(4.0, first=True, publishers=1)
    wait.saw(3.98)
    assert wait.has_to_wait(4.0, first=True, publishers=1)
    wait.saw(4.0)
    assert not wait.has_to_wait(4.0, first=True, publishers=1)


def test_a_later_one_waits_only_for_readings_that_count_for_it(wait: ImuWait) -> None:
    wait.saw(4.0)
    assert not wait.has_to_wait(4.1, first=False, publishers=0)
    assert wait.has_to_wait(4.12, first=False, publishers=0)
    pass_time(wait, imu_wait.LOST_SEC + TICK_SEC)
    assert not wait.has_to_wait(4.12, first=False, publishers=0), 'it is lost'
    wait.saw(4.04)
    assert not wait.has_to_wait(4.14, first=False, publishers=0)
    assert wait.has_to_wait(4.16, first=False, publishers=0), 'it should wait again'


@pytest.mark.parametrize(
    ('publishers', 'limit_sec'), [(0, imu_wait.NOBODY_SEC), (1, imu_wait.START_SEC)]
)
def test_without_an_imu_nobody_waits_for_long(
    wait: ImuWait, publishers: int, limit_sec: float
) -> None:
    assert wait.has_to_wait(0.0, first=True, publishers=publishers)
    pass_time(wait, limit_sec - TICK_SEC)
    assert wait.has_to_wait(0.0, first=True, publishers=publishers)
    assert not wait.is_missing
    wait.tick()
    assert not wait.has_to_wait(0.0, first=True, publishers=publishers)
    assert wait.is_missing
    assert not wait.has_to_wait(0.02, first=False, publishers=publishers)


def test_after_a_reset_readings_of_before_do_not_count(wait: ImuWait) -> None:
    wait.saw(60.0)
    wait.saw(0.0)
    assert wait.has_to_wait(0.5, first=False, publishers=1)
