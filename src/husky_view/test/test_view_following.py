# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The camera that follows a robot."""

from husky_course.frames import Array
from husky_view.picture.camera import ChaseCamera, REPORT_TIMEOUT_SEC, USER_PAUSE_SEC
import numpy as np

BEHIND, NEARER = np.array([-3.0, 0.0, 1.9]), np.array([0.0, 2.0, 1.0])
ROBOT = np.array([1.0, 0.0, 0.0])


def test_a_following_camera_keeps_its_distance_to_the_robot() -> None:
    behind = np.array([-3.0, 0.0, 1.9])
    camera = ChaseCamera(np.zeros(3), behind, now_sec=0.0)
    camera.report(behind)
    robot: Array = np.zeros(3)
    for frame in range(1, 91):
        robot = np.array([0.8 * frame / 30.0, 0.0, 0.0])
        assert camera.step(robot, now_sec=frame / 30.0)
        assert camera.offset is behind
        camera.report(behind)
    assert 0.0 < robot[0] - camera.at[0] < 0.2, 'it lags a little behind'
    for frame in range(91, 150):
        camera.step(robot, now_sec=frame / 30.0)
        camera.report(behind)
    np.testing.assert_allclose(camera.at, robot, atol=0.001)
    assert not camera.step(robot, now_sec=6.0), 'nothing moves, so nothing is sent'


def test_the_next_pose_is_sent_after_a_report_or_a_timeout() -> None:
    behind, robot = np.array([-3.0, 0.0, 1.9]), np.array([1.0, 0.0, 0.0])
    camera = ChaseCamera(np.zeros(3), behind, now_sec=0.0)
    assert camera.step(robot, now_sec=0.1)
    assert not camera.step(robot, now_sec=0.13)
    at = camera.at
    camera.report(behind)
    assert camera.step(robot, now_sec=0.16)
    assert camera.at[0] > at[0]
    assert not camera.step(robot, now_sec=0.15 + REPORT_TIMEOUT_SEC)
    assert camera.step(robot, now_sec=0.17 + REPORT_TIMEOUT_SEC)


def zoomed_camera() -> ChaseCamera:
    """Follow the robot until 0.1 s, then be zoomed in by a person."""
    camera = ChaseCamera(np.zeros(3), BEHIND, now_sec=0.0)
    camera.report(BEHIND)
    assert camera.step(ROBOT, now_sec=0.1)
    camera.report(NEARER)
    return camera


def test_the_camera_stands_after_input_and_keeps_the_new_view() -> None:
    camera = zoomed_camera()
    assert not camera.step(ROBOT, now_sec=0.2), 'it pulls at the camera that a person holds'
    camera.report(BEHIND)  # a pose that was still on its way to the page
    assert not camera.step(ROBOT, now_sec=0.2 + 0.9 * USER_PAUSE_SEC)
    assert camera.step(ROBOT, now_sec=0.3 + USER_PAUSE_SEC)
    assert camera.offset is NEARER


def test_a_pose_that_reaches_the_page_late_undoes_no_input() -> None:
    camera = zoomed_camera()
    assert not camera.step(ROBOT, now_sec=0.2)
    camera.report(BEHIND)  # the pose sent at 0.1 s
    assert camera.step(ROBOT, now_sec=0.3 + USER_PAUSE_SEC), 'the page gets the new view again'
    assert camera.offset is NEARER


def test_nor_does_it_where_a_turn_of_the_wheel_is_reported_in_parts() -> None:
    camera, nearest = zoomed_camera(), 0.8 * NEARER
    assert not camera.step(ROBOT, now_sec=0.2)
    camera.report(nearest)
    assert not camera.step(ROBOT, now_sec=0.25)
    late_sec = 0.3 + 2.0 * USER_PAUSE_SEC
    assert camera.step(ROBOT, now_sec=late_sec)
    camera.report(BEHIND)  # the pose sent at 0.1 s
    camera.step(ROBOT, now_sec=late_sec + 0.01)
    assert camera.offset is nearest


def test_nor_does_it_where_the_page_has_reported_the_input_twice() -> None:
    camera = zoomed_camera()
    assert not camera.step(ROBOT, now_sec=0.2)
    camera.report(1.001 * NEARER)  # the end of a smooth turn of the wheel
    assert not camera.step(ROBOT, now_sec=0.25)
    camera.report(BEHIND)  # the pose sent at 0.1 s
    camera.step(ROBOT, now_sec=0.3)
    assert camera.offset is NEARER


def test_a_report_older_than_the_first_pose_is_not_input() -> None:
    behind, before = np.array([-3.0, 0.0, 1.9]), np.array([-9.0, -8.0, 9.0])
    camera = ChaseCamera(np.zeros(3), behind, now_sec=0.0)
    camera.report(before)
    assert camera.step(np.zeros(3), now_sec=0.05), 'it is sent again until the page has it'
    assert camera.offset is behind
    camera.report(behind)
    assert not camera.step(np.zeros(3), now_sec=0.1)


def test_a_camera_jumps_with_a_robot_that_is_reset() -> None:
    camera = ChaseCamera(np.zeros(3), np.array([-3.0, 0.0, 1.9]), now_sec=0.0)
    far = np.array([9.0, 0.0, 0.0])
    assert camera.step(far, now_sec=0.01)
    assert camera.at.tolist() == far.tolist()
