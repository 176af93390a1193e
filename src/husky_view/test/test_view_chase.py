# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The camera that follows a robot."""

from husky_view.picture.chase import Chase, ECHO_SEC, HANDS_OFF_SEC
import numpy as np


def test_a_camera_that_follows_comes_after_the_robot_and_keeps_its_distance() -> None:
    behind = np.array([-3.0, 0.0, 1.9])
    chase = Chase(np.zeros(3), behind, now_sec=0.0)
    chase.report(behind)
    robot = np.zeros(3)
    for frame in range(1, 91):
        robot = np.array([0.8 * frame / 30.0, 0.0, 0.0])
        assert chase.step(robot, now_sec=frame / 30.0)
        assert chase.offset is behind
        chase.report(behind)
    assert 0.0 < robot[0] - chase.at[0] < 0.2, 'it glides a little behind'
    for frame in range(91, 150):
        chase.step(robot, now_sec=frame / 30.0)
        chase.report(behind)
    np.testing.assert_allclose(chase.at, robot, atol=0.001)
    assert not chase.step(robot, now_sec=6.0), 'nothing moves, so nothing is sent'


def test_a_page_gets_its_next_camera_when_it_has_told_of_the_last_or_is_slow_to() -> None:
    behind, robot = np.array([-3.0, 0.0, 1.9]), np.array([1.0, 0.0, 0.0])
    chase = Chase(np.zeros(3), behind, now_sec=0.0)
    assert chase.step(robot, now_sec=0.1)
    assert not chase.step(robot, now_sec=0.13)
    at = chase.at
    chase.report(behind)
    assert chase.step(robot, now_sec=0.16)
    assert chase.at[0] > at[0]
    assert not chase.step(robot, now_sec=0.15 + ECHO_SEC)
    assert chase.step(robot, now_sec=0.17 + ECHO_SEC)


def test_who_turns_or_zooms_has_the_camera_alone_and_then_it_follows_from_there() -> None:
    behind, nearer = np.array([-3.0, 0.0, 1.9]), np.array([0.0, 2.0, 1.0])
    chase = Chase(np.zeros(3), behind, now_sec=0.0)
    chase.report(behind)
    robot = np.array([1.0, 0.0, 0.0])
    assert chase.step(robot, now_sec=0.1)
    chase.report(nearer)
    assert not chase.step(robot, now_sec=0.2), 'it pulls at the camera that a person holds'
    chase.report(behind)  # by what was on its way to the page
    assert not chase.step(robot, now_sec=0.2 + 0.9 * HANDS_OFF_SEC)
    assert chase.step(robot, now_sec=0.3 + HANDS_OFF_SEC)
    assert chase.offset is nearer


def test_what_a_page_tells_of_before_it_got_its_camera_is_not_a_persons_doing() -> None:
    behind, before = np.array([-3.0, 0.0, 1.9]), np.array([-9.0, -8.0, 9.0])
    chase = Chase(np.zeros(3), behind, now_sec=0.0)
    chase.report(before)
    assert chase.step(np.zeros(3), now_sec=0.05), 'it is sent again until the page has it'
    assert chase.offset is behind
    chase.report(behind)
    assert not chase.step(np.zeros(3), now_sec=0.1)


def test_a_camera_jumps_with_a_robot_that_is_reset() -> None:
    chase = Chase(np.zeros(3), np.array([-3.0, 0.0, 1.9]), now_sec=0.0)
    far = np.array([9.0, 0.0, 0.0])
    assert chase.step(far, now_sec=0.01)
    assert chase.at.tolist() == far.tolist()
