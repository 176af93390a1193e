# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys
import time
from typing import Any

from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal
from rclpy.action import ActionClient
from ros2_diagnosis.nodes import SEND_GOAL
from ros2cli import arguments, discovery, interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node, CommandNode
from ros2cli.verb import VerbExtension
from ros2topic import topics
from rosidl_runtime_py import message_to_yaml

_STATUS = {
    GoalStatus.STATUS_ACCEPTED: 'ACCEPTED',
    GoalStatus.STATUS_EXECUTING: 'EXECUTING',
    GoalStatus.STATUS_CANCELING: 'CANCELING',
    GoalStatus.STATUS_SUCCEEDED: 'SUCCEEDED',
    GoalStatus.STATUS_CANCELED: 'CANCELED',
    GoalStatus.STATUS_ABORTED: 'ABORTED',
}
_SOON_SEC = 0.2  # a server that is there is found sooner
_CANCEL_TIMEOUT_SEC = 1.5  # for all of it: a command ends within 2 s of Ctrl-C


class SendGoalVerb(VerbExtension):
    """Send an action goal."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_action(parser, help="Name of the ROS action (e.g. '/fibonacci')")
        arguments.add_type(
            parser,
            'action_type',
            'action',
            help="Type of the ROS action (e.g. 'example_interfaces/action/Fibonacci')",
        )
        group = parser.add_mutually_exclusive_group()
        arguments.add_values(
            group,
            'goal',
            'action_type',
            help="Goal request values in YAML format (e.g. '{order: 10}')",
        )
        group.add_argument('--stdin', action='store_true', help='Read goal from standard input')
        arguments.add_flags(parser, {'-f --feedback': 'Echo feedback messages for the goal'})
        parser.add_argument(
            '-t',
            '--timeout',
            type=arguments.positive_float,
            help='Maximum time in seconds to wait for the action server and its result',
        )

    def main(self, *, args: argparse.Namespace) -> None:
        action_class = interfaces.action(args.action_type)
        goal = action_class.Goal()
        text = sys.stdin.read() if args.stdin else args.goal
        interfaces.populate(goal, interfaces.yaml_mapping(text), told='message fields')
        with command_node(args, may_spin_when_interrupted=True) as node:
            client = ActionClient(node.node, action_class, topics.checked_name(args.action_name))
            try:
                _send(node, client, goal, args)
            finally:
                client.destroy()


def _send(node: CommandNode, client: ActionClient, goal: Any, args: argparse.Namespace) -> None:
    print('Waiting for an action server to become available...')
    action = topics.checked_name(args.action_name)
    if not _is_offered(node, client, f'{action}{SEND_GOAL}', args.timeout):
        raise CommandError(f"No action server for '{args.action_name}' within {args.timeout:g} s")
    with node.found(f'{action}{SEND_GOAL}'):
        print(f'Sending goal:\n     {message_to_yaml(goal)}')
        sending = client.send_goal_async(goal, _print_feedback if args.feedback else None)
        try:
            done = _follow(node, client, sending, args)
        except KeyboardInterrupt:
            _cancel(node, sending)
            raise
        if not done:
            _cancel(node, sending)
            raise CommandError(f'No result within {args.timeout:g} s: the goal was canceled')


def _is_offered(
    node: CommandNode, client: ActionClient, service: str, timeout_sec: float | None
) -> bool:
    soon_sec = _SOON_SEC if timeout_sec is None else min(_SOON_SEC, timeout_sec)
    start = time.monotonic()
    if node.spin_until(client.server_is_ready, soon_sec):
        return True
    discovery.hint_when_not_offered(service)
    left_sec = None if timeout_sec is None else start + timeout_sec - time.monotonic()
    return node.spin_until(client.server_is_ready, left_sec)


def _follow(
    node: CommandNode, client: ActionClient, sending: Any, args: argparse.Namespace
) -> bool:
    """Print the goal's way to its end; False where the time is over before."""
    action = topics.checked_name(args.action_name)
    end = None if args.timeout is None else time.monotonic() + args.timeout
    service = f'{action}{SEND_GOAL}'
    if not node.spin_until_answered(sending, service, client.server_is_ready, args.timeout):
        return False
    handle = sending.result()
    if not handle.accepted:
        print('Goal was rejected.')
        return True
    print(f'Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n')
    getting = handle.get_result_async()
    node.spin_until(lambda: getting.done() or not client.server_is_ready(), _left(end))
    # A server may end just after its result, which is on its way then.
    if not node.spin_until(getting.done, _left(end, at_most=_SOON_SEC)):
        if not client.server_is_ready():
            print(
                f'hint: {action}: its server has ended, so that no result '
                'comes; Ctrl-C ends the waiting',
                file=sys.stderr,
            )
        if not node.spin_until(getting.done, _left(end)):
            return False
    _print_result(getting.result())
    return True


def _left(end: float | None, *, at_most: float | None = None) -> float | None:
    """Return the time until an end, None where there is none."""
    if end is None:
        return at_most
    left_sec = max(0.0, end - time.monotonic())
    return left_sec if at_most is None else min(left_sec, at_most)


def _cancel(node: CommandNode, sending: Any) -> None:
    """Cancel a goal that has been sent, whether or not the server has answered yet."""
    print('Canceling goal...')
    end = time.monotonic() + _CANCEL_TIMEOUT_SEC

    def answer(future: Any) -> Any:
        if not node.spin_until(future.done, end - time.monotonic()):
            raise CommandError(
                'Failed to cancel goal: the server does not answer, and may still carry it out'
            )
        return future.result()

    handle = answer(sending)
    if not handle.accepted:
        print('Goal was rejected.')
        return
    canceling = answer(handle.cancel_goal_async())
    if canceling.goals_canceling:
        print('Goal canceled.')
    elif canceling.return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED:
        print('The goal had already ended.')
    else:
        raise CommandError('Failed to cancel goal: the server refuses, and carries it out')
    getting = handle.get_result_async()
    if node.spin_until(getting.done, end - time.monotonic()):
        _print_result(getting.result())


def _print_result(answer: Any) -> None:
    print(f'Result:\n    {message_to_yaml(answer.result)}')
    print(f'Goal finished with status: {_STATUS.get(answer.status, "UNKNOWN")}')


def _print_feedback(feedback: Any) -> None:
    print(f'Feedback:\n    {message_to_yaml(feedback.feedback)}')
