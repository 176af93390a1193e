# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""control_msgs: an arm follows a trajectory, a client hears how far it is and why it stops."""

from __future__ import annotations

from typing import Any

from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance, MotionPrimitive, VDA5050SafetyState
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
from rclpy.action import ActionClient, ActionServer
from rclpy.duration import Duration
from rclpy.node import Node
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

Goal, Result = FollowJointTrajectory.Goal, FollowJointTrajectory.Result
STRAYED = Result.PATH_TOLERANCE_VIOLATED


def follow(handle: Any) -> Any:
    """Come near each point, and give up where the elbow may stray less than that."""
    request, feedback = handle.request, FollowJointTrajectory.Feedback()
    for point in request.trajectory.points:
        feedback.desired = point
        feedback.error.positions = [0.125]
        handle.publish_feedback(feedback)
    handle.abort()
    return Result(error_code=STRAYED, error_string=request.path_tolerance[0].name)


def test_a_client_hears_of_its_trajectory(domain: int) -> None:
    with SpunNodes(domain) as nodes:
        arm, node = nodes.start(Node, 'arm'), nodes.start(Node, 'planner')
        server = ActionServer(arm, FollowJointTrajectory, 'follow_joint_trajectory', follow)
        client = ActionClient(node, FollowJointTrajectory, 'follow_joint_trajectory')
        assert client.wait_for_server(timeout_sec=10.0)
        wait_until(
            lambda: arm.count_subscribers('follow_joint_trajectory/_action/feedback') == 1,
            timeout_sec=10.0,
            what='who hears how far it is',
        )
        points = [
            JointTrajectoryPoint(
                positions=[angle], time_from_start=Duration(seconds=angle).to_msg()
            )
            for angle in (0.5, 1.0)
        ]
        goal = Goal(
            trajectory=JointTrajectory(joint_names=['elbow'], points=points),
            path_tolerance=[JointTolerance(name='elbow', position=0.1)],
        )
        heard: list[Any] = []
        sent = client.send_goal_async(goal, feedback_callback=heard.append)
        wait_until(sent.done, timeout_sec=10.0, what='an answer to the goal')
        ended = sent.result().get_result_async()
        wait_until(ended.done, timeout_sec=10.0, what='a result')
        result = ended.result().result
        assert (result.error_code, result.error_string) == (STRAYED, 'elbow')
        wait_until(lambda: len(heard) == 2, timeout_sec=10.0, what='what it says on its way')
        assert [each.feedback.desired for each in heard] == points
        assert list(heard[0].feedback.error.positions) == [0.125]
        client.destroy()
        server.destroy()


def test_constants_and_defaults_are_those_of_jazzy() -> None:
    assert (STRAYED, Result.INVALID_GOAL, Result.SUCCESSFUL) == (-4, -1, 0)
    assert MotionPrimitive().type == MotionPrimitive.UNKNOWN == -1
    assert (VDA5050SafetyState.AUTO_ACK, VDA5050SafetyState.NONE) == ('autoAck', 'none')
