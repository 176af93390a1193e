# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ask for numbers of Fibonacci, log them as they come, and end with the last."""

from __future__ import annotations

import sys
from typing import Any

from action_tutorials_interfaces.action import Fibonacci
from node_program import in_steps, run_node, Spinner
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.task import Future

ORDER = 10
_LAST_WORDS_SEC = 1.0  # what a server sent before its end may come after that is noticed


class FibonacciActionClient(Node):
    """Sends a goal, and logs what becomes of it."""

    def __init__(self) -> None:
        super().__init__('fibonacci_action_client')
        self._client = ActionClient(self, Fibonacci, 'fibonacci')

    def send_goal(self, order: int, spinner: Spinner) -> bool:
        """Wait for the server, then for the result; return whether there is one."""
        spinner.until(self._client.server_is_ready)
        sending = self._client.send_goal_async(
            Fibonacci.Goal(order=order), feedback_callback=self._on_feedback
        )
        if not self._comes(sending, spinner):
            return False
        goal = sending.result()
        if not goal.accepted:
            self.get_logger().info('Goal rejected :(')
            return False
        self.get_logger().info('Goal accepted :)')
        getting = goal.get_result_async()
        if not self._comes(getting, spinner):
            return False
        self.get_logger().info(f'Result: {getting.result().result.sequence}')
        return True

    def _comes(self, answer: Future[Any], spinner: Spinner) -> bool:
        spinner.until(lambda: answer.done() or not self._client.server_is_ready())
        if spinner.until(answer.done, _LAST_WORDS_SEC):
            return True
        self.get_logger().error('The action server ended before it had answered')
        return False

    def _on_feedback(self, message: Fibonacci.Impl.FeedbackMessage) -> None:
        self.get_logger().info(f'Received feedback: {message.feedback.partial_sequence}')

    def destroy_node(self) -> None:
        self._client.destroy()
        super().destroy_node()


def _steps(node: FibonacciActionClient, spinner: Spinner) -> int:
    return 0 if node.send_goal(ORDER, spinner) else 1


def main(args: list[str] | None = None) -> int:
    return run_node(
        lambda _: FibonacciActionClient(), sys.argv if args is None else args, in_steps(_steps)
    )


if __name__ == '__main__':
    sys.exit(main())
