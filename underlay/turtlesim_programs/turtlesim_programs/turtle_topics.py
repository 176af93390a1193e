# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topics, the services and the action of one turtle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import math
from typing import Any

from geometry_msgs.msg import Twist
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import QoSProfile
from turtlesim.action import RotateAbsolute
from turtlesim.msg import Color, Pose
from turtlesim.srv import SetPen, TeleportAbsolute, TeleportRelative

from turtlesim_programs.frame import Seen
from turtlesim_programs.motion import Pen, Rotation, SIDE_M, Teleport, Turtle

QOS = QoSProfile(depth=7)  # reliable
FASTEST = 1e30  # m/s and rad/s; a Pose carries single precision


@dataclass(frozen=True)
class _Turn:
    goal: ServerGoalHandle
    rotation: Rotation


class _WithOwnClock:
    """A node but for its clock: executors find many timers on one clock slow, and print so.

    Each action server has a timer, on the clock of its node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clock = Clock(clock_type=ClockType.SYSTEM_TIME)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._node, name)

    def get_clock(self) -> Clock:
        return self._clock


class RotationServer(ActionServer):
    """An action whose goals end when `finish` is called.

    An execute callback that waits would be asked again and again whether it still does.
    """

    def notify_execute(
        self, goal_handle: ServerGoalHandle, execute_callback: Callable[..., Any] | None
    ) -> None:
        """Begin nothing: the steps of the turtle do."""

    def finish(self, goal: ServerGoalHandle, result: RotateAbsolute.Result) -> None:
        """Send the result of a goal that has succeeded, was aborted or canceled."""
        super().notify_execute(goal, lambda _: result)


class TurtleTopics:
    """
    What a turtle offers under its name.

    :param now: the time in seconds, by which a command counts.
    """

    def __init__(self, node: Node, name: str, turtle: Turtle, now: Callable[[], float]) -> None:
        self._node, self._turtle, self._now = node, turtle, now
        self._logger = node.get_logger()
        self._turn: _Turn | None = None
        self._velocities = node.create_subscription(
            Twist, f'{name}/cmd_vel', self._on_velocity, QOS
        )
        self._poses = node.create_publisher(Pose, f'{name}/pose', QOS)
        self._colours = node.create_publisher(Color, f'{name}/color_sensor', QOS)
        self._services = [
            node.create_service(kind, f'{name}/{word}', answer)
            for kind, word, answer in (
                (SetPen, 'set_pen', self._on_set_pen),
                (TeleportAbsolute, 'teleport_absolute', self._on_teleport_absolute),
                (TeleportRelative, 'teleport_relative', self._on_teleport_relative),
            )
        ]
        self._rotations = RotationServer(
            _WithOwnClock(node),
            RotateAbsolute,
            f'{name}/rotate_absolute',
            execute_callback=lambda _: None,
            goal_callback=self._on_goal_request,
            handle_accepted_callback=self._on_goal,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    def before_step(self) -> None:
        """End a rotation that is to be canceled."""
        if self._turn and self._turn.goal.is_cancel_requested:
            self._logger.info('Rotation goal canceled')
            self._turtle.stop()
            self._end_turn(self._turn, self._turn.goal.canceled)

    def after_step(self, seen: Seen) -> None:
        """Tell where the turtle is now, what it sees and how far a rotation is."""
        turtle = self._turtle
        if seen.step.outside:
            x, y = seen.step.outside  # upstream tells y from the top
            self._logger.warning(
                f'Oh no! I hit the wall! (Clamping from [x={x:f}, y={SIDE_M - y:f}])'
            )
        self._poses.publish(
            Pose(
                x=turtle.x,
                y=turtle.y,
                theta=turtle.theta,
                linear_velocity=turtle.speed,
                angular_velocity=turtle.angular,
            )
        )
        red, green, blue = seen.colour
        self._colours.publish(Color(r=red, g=green, b=blue))
        if self._turn:
            self._tell_turn(self._turn)

    def destroy(self) -> None:
        """Abort what is under way, then offer nothing any more."""
        if self._turn:
            self._end_turn(self._turn, self._turn.goal.abort)
        # A result leaves by two tasks of the executor, the second of which the first one makes.
        executor = self._node.executor
        executor.create_task(lambda: executor.create_task(self._destroy) and None)

    def _destroy(self) -> None:
        self._rotations.destroy()
        for service in self._services:
            self._node.destroy_service(service)
        self._node.destroy_subscription(self._velocities)
        for publisher in (self._poses, self._colours):
            self._node.destroy_publisher(publisher)

    def _on_velocity(self, twist: Twist) -> None:
        linear, angular = (twist.linear.x, twist.linear.y), twist.angular.z
        if not all(abs(velocity) <= FASTEST for velocity in (*linear, angular)):
            self._logger.error(
                f'A command is refused: its velocities must be numbers up to {FASTEST:g}, not '
                f'x={linear[0]}, y={linear[1]} and z={angular}'
            )
            return
        holonomic = self._node.get_parameter('holonomic').value
        self._turtle.command((linear[0], linear[1] if holonomic else 0.0), angular, self._now())
        if self._turn:
            self._logger.warning('Velocity command received during rotation goal. Aborting goal')
            self._end_turn(self._turn, self._turn.goal.abort)

    def _on_set_pen(self, request: SetPen.Request, response: SetPen.Response) -> SetPen.Response:
        colour = (request.r, request.g, request.b)
        self._turtle.pen = None if request.off else Pen(colour, request.width or 1)
        return response

    def _on_teleport_absolute(
        self, request: TeleportAbsolute.Request, response: TeleportAbsolute.Response
    ) -> TeleportAbsolute.Response:
        if self._are_numbers(request.x, request.y, request.theta):
            self._turtle.teleport(Teleport(request.theta, place=(request.x, request.y)))
        return response

    def _on_teleport_relative(
        self, request: TeleportRelative.Request, response: TeleportRelative.Response
    ) -> TeleportRelative.Response:
        if self._are_numbers(request.linear, request.angular):
            self._turtle.teleport(Teleport(request.angular, ahead=request.linear, relative=True))
        return response

    def _are_numbers(self, *values: float) -> bool:
        if not all(map(math.isfinite, values)):
            said = ', '.join(map(str, values))
            self._logger.error(f'A turtle cannot go to {said}: it needs finite numbers')
            return False
        return True

    def _on_goal_request(self, goal: RotateAbsolute.Goal) -> GoalResponse:
        return GoalResponse.ACCEPT if self._are_numbers(goal.theta) else GoalResponse.REJECT

    def _on_goal(self, goal: ServerGoalHandle) -> None:
        if self._turn:
            self._logger.warning(
                'Rotation goal received before a previous goal finished. Aborting previous goal'
            )
            self._end_turn(self._turn, self._turn.goal.abort)
        goal.execute()
        self._turn = _Turn(goal, self._turtle.rotate_to(goal.request.theta))

    def _tell_turn(self, turn: _Turn) -> None:
        turn.goal.publish_feedback(RotateAbsolute.Feedback(remaining=turn.rotation.remaining))
        if turn.rotation.reached:
            self._logger.info('Rotation goal completed successfully')
            self._end_turn(turn, turn.goal.succeed)

    def _end_turn(self, turn: _Turn, end: Callable[[], None]) -> None:
        self._turn = None
        end()
        self._rotations.finish(turn.goal, RotateAbsolute.Result(delta=turn.rotation.delta))
