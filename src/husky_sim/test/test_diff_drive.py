# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The velocity controller, without physics."""

import math

from husky_course.frames import wrapped
from husky_sim.robot.diff_drive import VelocityController, WheelOdometry
from hypothesis import given
from hypothesis import strategies as st
import pytest

from husky_sim.config import DriveConfig

PERIOD_SEC = 0.02


@pytest.fixture
def controller() -> VelocityController:
    return VelocityController(DriveConfig())


def updates(controller: VelocityController, count: int, *, first: int = 0) -> list[bool]:
    return [
        controller.update(time_sec=(first + i) * PERIOD_SEC, period_sec=PERIOD_SEC)
        for i in range(count)
    ]


def test_the_speed_rises_no_faster_than_the_acceleration_limit(
    controller: VelocityController,
) -> None:
    controller.command(1.0, 0.0, time_sec=0.0)
    updates(controller, 1)
    assert controller.speed_m_s == pytest.approx(0.06)
    updates(controller, 9, first=1)
    assert controller.speed_m_s == pytest.approx(0.6)


@given(speed=st.floats(-1e6, 1e6), yaw_rate=st.floats(-1e6, 1e6))
def test_no_command_gets_past_the_limits(speed: float, yaw_rate: float) -> None:
    controller = VelocityController(DriveConfig())
    for step in range(60):
        before = controller.speed_m_s, controller.yaw_rate_rad_s
        controller.command(speed, yaw_rate, time_sec=step * PERIOD_SEC)
        controller.update(time_sec=step * PERIOD_SEC, period_sec=PERIOD_SEC)
        assert abs(controller.speed_m_s) <= 1.0
        assert abs(controller.yaw_rate_rad_s) <= 2.0
        assert abs(controller.speed_m_s - before[0]) <= 3.0 * PERIOD_SEC + 1e-12
        assert abs(controller.yaw_rate_rad_s - before[1]) <= 6.0 * PERIOD_SEC + 1e-12


def test_a_command_older_than_the_timeout_stops_the_robot(controller: VelocityController) -> None:
    controller.command(0.06, 0.0, time_sec=0.0)
    updates(controller, 13)
    assert controller.speed_m_s == pytest.approx(0.06)
    assert updates(controller, 2, first=13) == [True, False]
    assert controller.speed_m_s == 0.0


def test_the_timeout_says_nothing_of_a_robot_that_stands(controller: VelocityController) -> None:
    controller.command(0.0, 0.0, time_sec=0.0)
    assert not any(updates(controller, 50))


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_a_command_that_is_not_finite_stops_the_robot(
    controller: VelocityController, bad: float
) -> None:
    controller.command(0.06, 0.0, time_sec=0.0)
    updates(controller, 1)
    with pytest.raises(ValueError, match=r'must be a finite number; stopping'):
        controller.command(0.06, bad, time_sec=0.02)
    updates(controller, 1, first=1)
    assert (controller.speed_m_s, controller.yaw_rate_rad_s) == (0.0, 0.0)


def test_wheel_speeds_follow_from_the_effective_track(controller: VelocityController) -> None:
    controller.speed_m_s, controller.yaw_rate_rad_s = 0.5, 1.0
    left, right = controller.wheel_speeds_rad_s()
    assert (left + right) / 2.0 * 0.1651 == pytest.approx(0.5)
    assert (right - left) * 0.1651 / (0.5708 * 1.875) == pytest.approx(1.0)


def test_wheel_odometry_of_a_quarter_circle_ends_on_the_circle() -> None:
    odometry = WheelOdometry(DriveConfig())
    half_track = DriveConfig().wheel_separation_m / 2.0
    radius_m, steps = 2.0, 100
    for step in range(steps + 1):
        angle = math.pi / 2.0 * step / steps
        left = (radius_m - half_track) * angle / 0.1651
        right = (radius_m + half_track) * angle / 0.1651
        odometry.update(left, right, period_sec=PERIOD_SEC)
    assert (odometry.x, odometry.y) == pytest.approx((2.0, 2.0))
    assert odometry.yaw == pytest.approx(math.pi / 2.0)
    assert odometry.speed_m_s == pytest.approx(radius_m * math.pi / 2.0 / steps / PERIOD_SEC)


def test_wheel_odometry_starts_at_the_origin_at_any_angles() -> None:
    odometry = WheelOdometry(DriveConfig())
    odometry.update(123.0, -45.0, period_sec=PERIOD_SEC)
    assert (odometry.x, odometry.y, odometry.yaw, odometry.speed_m_s) == (0.0, 0.0, 0.0, 0.0)


@given(angle=st.floats(-1e3, 1e3))
def test_a_wrapped_angle_points_the_same_way(angle: float) -> None:
    assert -math.pi <= wrapped(angle) <= math.pi
    assert math.cos(wrapped(angle)) == pytest.approx(math.cos(angle), abs=1e-9)
