# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which odometry waits for readings of the IMU, and for how long."""

from husky_driver.ros import imu_wait
from husky_driver.ros.imu_wait import ImuWait
import pytest


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Make the wall's time a number that a test sets."""
    now = [100.0]
    monkeypatch.setattr('husky_driver.ros.imu_wait.monotonic', lambda: now[0])
    return now


def test_the_first_odometry_waits_for_the_reading_of_its_moment(clock: list[float]) -> None:
    wait = ImuWait()
    assert wait.has_to_wait(4.0, first=True, publishers=1)
    wait.saw(3.98)
    assert wait.has_to_wait(4.0, first=True, publishers=1)
    wait.saw(4.0)
    assert not wait.has_to_wait(4.0, first=True, publishers=1)
    assert clock == [100.0]


def test_a_later_one_waits_only_for_readings_that_count_for_it(clock: list[float]) -> None:
    wait = ImuWait()
    wait.saw(4.0)
    assert not wait.has_to_wait(4.1, first=False, publishers=0)
    assert wait.has_to_wait(4.12, first=False, publishers=0)
    clock[0] += imu_wait.LOST_SEC + 0.01
    assert not wait.has_to_wait(4.12, first=False, publishers=0), 'it is lost'
    wait.saw(4.04)
    assert not wait.has_to_wait(4.14, first=False, publishers=0)
    assert wait.has_to_wait(4.16, first=False, publishers=0), 'it should wait again'


@pytest.mark.parametrize(
    ('publishers', 'limit_sec'), [(0, imu_wait.NOBODY_SEC), (1, imu_wait.START_SEC)]
)
def test_without_an_imu_nobody_waits_for_long(
    clock: list[float], publishers: int, limit_sec: float
) -> None:
    wait = ImuWait()
    assert wait.has_to_wait(0.0, first=True, publishers=publishers)
    clock[0] += limit_sec - 0.01
    assert wait.has_to_wait(0.0, first=True, publishers=publishers)
    assert not wait.is_missing
    clock[0] += 0.02
    assert not wait.has_to_wait(0.0, first=True, publishers=publishers)
    assert wait.is_missing
    assert not wait.has_to_wait(0.02, first=False, publishers=publishers)


def test_after_a_reset_readings_of_before_do_not_count(clock: list[float]) -> None:
    wait = ImuWait()
    wait.saw(60.0)
    wait.saw(0.0)
    assert wait.has_to_wait(0.5, first=False, publishers=1)
    assert clock == [100.0]
