# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import math

from husky_course.frames import to_odom, to_world
from husky_course.robot import RobotStart
import numpy as np
import pytest

START = (1.0, 2.0, math.pi / 2)


def test_ahead_of_a_robot_that_faces_y_is_along_y() -> None:
    assert to_world(START, 3.0, 0.0) == pytest.approx((1.0, 5.0))
    assert to_odom(START, 1.0, 5.0) == pytest.approx((3.0, 0.0))


def test_ahead_and_left_of_a_robot_that_faces_anywhere() -> None:
    start = (1.0, 2.0, -math.pi / 6)
    place = (1.0 + 0.75**0.5 * 2.0 + 0.5, 2.0 - 1.0 + 0.75**0.5)
    assert to_world(start, 2.0, 1.0) == pytest.approx(place)
    assert to_odom(start, *place) == pytest.approx((2.0, 1.0))


def test_arrays_give_the_same_bits_as_numbers() -> None:
    x = np.linspace(-5.0, 5.0, 101, dtype=np.float64)
    y = np.linspace(3.0, -7.0, 101, dtype=np.float64)
    start = (0.3, -1.7, 0.9)
    for convert in (to_world, to_odom):
        many = np.stack(convert(start, x, y), axis=1).tolist()
        places = zip(x.tolist(), y.tolist(), strict=True)
        assert many == [list(convert(start, *place)) for place in places]


def test_a_robot_is_read_from_its_line() -> None:
    robot = RobotStart.parse('husky_beta 1.0 3 -0.5')
    assert robot == RobotStart(name='husky_beta', x=1.0, y=3.0, yaw=-0.5)
    assert robot.pose == (1.0, 3.0, -0.5)


@pytest.mark.parametrize(
    'line',
    [
        *('', 'a/b 0 0 0', 'a 0 0', 'a 0 0 nan', 'a 0 0 0 0', '1a 0 0 0'),
        *('a__b 0 0 0', f'{"a" * 300} 0 0 0'),
    ],
)
def test_a_line_of_another_form_is_refused(line: str) -> None:
    with pytest.raises(ValueError, match="a robot is 'NAME X Y YAW', a name of letters"):
        RobotStart.parse(line)
