# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Count the numbers of Fibonacci, one a second, for whoever sends a goal."""

from __future__ import annotations

import sys
import threading

from action_tutorials_interfaces.action import Fibonacci
from node_program import run_node
from rclpy.action import ActionServer, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node

PERIOD_SEC = 1.0
LARGEST_ORDER = 46  # the next number is more than an int32 holds


class FibonacciActionServer(Node):
    """
    Does one goal after another; while it does, it answers nothing else.

    :param stop: ends a goal that is being done.
    """

    def __init__(self, stop: threading.Event | None = None) -> None:
        super().__init__('fibonacci_action_server')
        self._stop = stop or threading.Event()
        self._server = ActionServer(
            self, Fibonacci, 'fibonacci', self._execute, goal_callback=self._on_goal
        )

    def _on_goal(self, goal: Fibonacci.Goal) -> GoalResponse:
        if goal.order <= LARGEST_ORDER:
            return GoalResponse.ACCEPT
        self.get_logger().warning(
            f'order={goal.order} is refused: the numbers up to order {LARGEST_ORDER} fit an int32'
        )
        return GoalResponse.REJECT

    def _execute(self, goal: ServerGoalHandle) -> Fibonacci.Result:
        self.get_logger().info('Executing goal...')
        feedback = Fibonacci.Feedback(partial_sequence=[0, 1])
        numbers = feedback.partial_sequence
        for _ in range(1, goal.request.order):
            numbers.append(numbers[-1] + numbers[-2])
            self.get_logger().info(f'Feedback: {numbers}')
            goal.publish_feedback(feedback)
            if self._stop.wait(PERIOD_SEC):
                goal.abort()
                break
        else:
            goal.succeed()
        return Fibonacci.Result(sequence=numbers)

    def destroy_node(self) -> None:
        self._server.destroy()
        super().destroy_node()


def main(args: list[str] | None = None) -> int:
    return run_node(FibonacciActionServer, sys.argv if args is None else args)


if __name__ == '__main__':
    sys.exit(main())
