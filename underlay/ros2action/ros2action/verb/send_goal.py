# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from ros2cli import arguments, interfaces
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
_CANCEL_TIMEOUT_SEC = 5.0


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
        with command_node(args) as node:
            client = ActionClient(node.node, action_class, topics.checked_name(args.action_name))
            try:
                _send(node, client, goal, args)
            finally:
                client.destroy()


def _send(node: CommandNode, client: ActionClient, goal: Any, args: argparse.Namespace) -> None:
    print('Waiting for an action server to become available...')
    if not node.spin_until(client.server_is_ready, args.timeout):
        raise CommandError(f"No action server for '{args.action_name}' within {args.timeout:g} s")
    print(f'Sending goal:\n     {message_to_yaml(goal)}')
    future = client.send_goal_async(goal, _print_feedback if args.feedback else None)
    action = topics.checked_name(args.action_name)
    node.spin_until_answered(future, f'{action}/_action/send_goal')
    handle = future.result()
    if not handle.accepted:
        print('Goal was rejected.')
        return
    print(f'Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n')
    result = handle.get_result_async()
    try:
        done = node.spin_until(result.done, args.timeout)
    except KeyboardInterrupt:
        _cancel(node, handle)
        raise
    if not done:
        _cancel(node, handle)
        raise CommandError(f'No result within {args.timeout:g} s: the goal was canceled')
    print(f'Result:\n    {message_to_yaml(result.result().result)}')
    print(f'Goal finished with status: {_STATUS.get(result.result().status, "UNKNOWN")}')


def _cancel(node: CommandNode, handle: Any) -> None:
    print('Canceling goal...')
    canceling = handle.cancel_goal_async()
    if not node.spin_until(canceling.done, _CANCEL_TIMEOUT_SEC):
        raise CommandError('Failed to cancel goal: the server does not answer')
    if not canceling.result().goals_canceling:
        raise CommandError('Failed to cancel goal')
    print('Goal canceled.')


def _print_feedback(feedback: Any) -> None:
    print(f'Feedback:\n    {message_to_yaml(feedback.feedback)}')
