# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let turtle1 draw squares, one upon the other."""

from __future__ import annotations

from collections.abc import Callable
import math
import sys
from typing import NamedTuple

from geometry_msgs.msg import Twist
from node_program import run_node
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Empty
from turtlesim.msg import Pose

from turtlesim_programs.motion import PERIOD_SEC
from turtlesim_programs.turtle_topics import QOS

SIDE_M = 2.0
FORWARD_M_S = 1.0
TURN_RAD_S = 0.4


class Place(NamedTuple):
    x: float
    y: float
    theta: float


class Command(NamedTuple):
    forward_m_s: float
    turn_rad_s: float


STOP = Command(0.0, 0.0)


class Square:
    """
    Goes to a goal, stops, turns to the next, stops; the commands are a function of the poses.

    :param log: is told each goal, and that it is reached.
    """

    def __init__(self, log: Callable[[str], object]) -> None:
        self._log = log
        self._goal: Place | None = None
        self._turns = self._stops = False

    def command(self, pose: Pose) -> Command | None:
        """Return what the turtle is to do, None to let it be."""
        if self._goal is None:
            self._goal = self._new_goal(pose)
        if self._stops:
            return self._stop(pose)
        if _is_at(pose, self._goal):
            self._stops = True
            return STOP
        return Command(0.0, TURN_RAD_S) if self._turns else Command(FORWARD_M_S, 0.0)

    def _stop(self, pose: Pose) -> Command | None:
        if pose.linear_velocity >= 0.0001 or pose.angular_velocity >= 0.0001:
            return STOP
        self._log('Reached goal')
        self._turns, self._stops = not self._turns, False
        self._goal = self._new_goal(pose)
        return None

    def _new_goal(self, pose: Pose) -> Place:
        if self._turns:
            theta = math.fmod(pose.theta + math.pi / 2, math.tau)
            goal = Place(pose.x, pose.y, theta - math.tau if theta >= math.pi else theta)
        else:
            ahead = (math.cos(pose.theta) * SIDE_M, math.sin(pose.theta) * SIDE_M)
            goal = Place(pose.x + ahead[0], pose.y + ahead[1], pose.theta)
        self._log(f'New goal [{goal.x:f} {goal.y:f}, {goal.theta:f}]')
        return goal


def _is_at(pose: Pose, goal: Place) -> bool:
    return (
        abs(pose.x - goal.x) < 0.1
        and abs(pose.y - goal.y) < 0.1
        and abs(pose.theta - goal.theta) < 0.01
    )


class DrawSquare(Node):
    """Resets turtlesim, then commands turtle1."""

    def __init__(self) -> None:
        super().__init__('draw_square')
        self._square = Square(self.get_logger().info)
        self._pose: Pose | None = None
        self._reset: Future[Empty.Response] | None = None
        self._commands = self.create_publisher(Twist, 'turtle1/cmd_vel', QOS)
        self.create_subscription(Pose, 'turtle1/pose', self._on_pose, QOS)
        self._resetting = self.create_client(Empty, 'reset')
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(PERIOD_SEC, self._on_tick, clock=steady)

    def _on_pose(self, pose: Pose) -> None:
        self._pose = pose if self._reset and self._reset.done() else None

    def _on_tick(self) -> None:
        if self._reset is None and self._resetting.service_is_ready():
            self._reset = self._resetting.call_async(Empty.Request())
        command = self._square.command(self._pose) if self._pose else None
        if command:
            twist = Twist()
            twist.linear.x, twist.angular.z = command
            self._commands.publish(twist)


def main(argv: list[str] | None = None) -> int:
    return run_node(lambda _: DrawSquare(), sys.argv if argv is None else argv)


if __name__ == '__main__':
    sys.exit(main())
