# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import math

from husky_course.route import A200_LIMITS, LIMITS
from husky_driver.ros.settings import Settings
from husky_runtime.settings import refuse_unknown
import pytest


def test_each_choice_has_its_topic() -> None:
    assert Settings().odometry_topic == 'odometry/filtered'
    assert Settings(odometry='wheel').odometry_topic == 'husky_velocity_controller/odom'


def test_a_robot_has_the_limits_of_its_name() -> None:
    assert Settings().drive_limits == LIMITS
    assert Settings(limits='a200').drive_limits == A200_LIMITS


def test_a_value_that_is_not_offered_is_refused_with_what_is() -> None:
    with pytest.raises(ValueError, match="check: 'loudly' is not allowed; allowed: warn, refuse"):
        Settings(check='loudly')
    with pytest.raises(ValueError, match='imu_ahead_m: 3 is not allowed; allowed is -2 to 2'):
        Settings(imu_ahead_m=3)  # whole, as it is where somebody writes no decimal point
    with pytest.raises(ValueError, match=r'start: 2 numbers; write \[x, y, yaw\]'):
        Settings(start=(0.0, 1.0))
    with pytest.raises(ValueError, match=r'start must be of numbers, as \[0.0, 0.0, 0.0\]'):
        Settings(start=(0.0, math.nan, 0.0))  # else the odometry is blamed for it


def test_an_unknown_parameter_is_refused_with_a_suggestion() -> None:
    refuse_unknown(['waypoints', 'use_sim_time', 'qos_overrides./x.depth'], ['waypoints'])
    with pytest.raises(ValueError, match='wayponts does not exist; did you mean waypoints'):
        refuse_unknown(['wayponts'], ['waypoints'])
