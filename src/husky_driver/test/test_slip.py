# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from husky_driver.drive.slip import NO_SLIP, SlipCorrection, SlipModel
from husky_driver.motion import Odometry
import pytest


def corrected(correction: SlipCorrection, speed: float, rate: float) -> Odometry:
    """Return the correction of one second at a speed and yaw rate, with a constant pose."""
    result = Odometry(0.0, 0.0, 0.0, 0.0, speed, rate)
    for period in range(51):
        result = correction.corrected(result._replace(time_sec=period * 0.02, x_m=0.0, y_m=0.0))
    return result


def test_in_a_left_bend_the_slip_is_right_and_forward() -> None:
    found = corrected(SlipCorrection(SlipModel(0.04, 0.03)), 0.5, 0.2)
    assert (found.x_m, found.y_m) == pytest.approx((0.003, -0.004), abs=5e-5)


def test_a_robot_that_turns_right_is_carried_to_the_left() -> None:
    found = corrected(SlipCorrection(SlipModel(0.04, 0.03)), 0.5, -0.2)
    assert (found.x_m, found.y_m) == pytest.approx((0.003, 0.004), abs=5e-5)


def test_driving_backwards_the_slip_is_outward_and_onward_too() -> None:
    found = corrected(SlipCorrection(SlipModel(0.04, 0.03)), -0.5, 0.2)
    assert (found.x_m, found.y_m) == pytest.approx((-0.003, -0.004), abs=5e-5)


def test_straight_on_or_on_the_spot_nothing_is_added() -> None:
    for speed, rate in ((0.8, 0.0), (0.0, 1.5)):
        found = corrected(SlipCorrection(SlipModel()), speed, rate)
        assert (found.x_m, found.y_m) == (0.0, 0.0)


def test_without_slip_odometry_stays_as_it_is() -> None:
    found = corrected(SlipCorrection(NO_SLIP), 0.8, 1.0)
    assert (found.x_m, found.y_m) == (0.0, 0.0)
