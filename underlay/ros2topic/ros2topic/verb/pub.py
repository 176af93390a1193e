# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections.abc import Callable
import sys
import time
from typing import Any

from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.publisher import Publisher
from rclpy.qos import qos_policy_name_from_kind
from ros2cli import arguments, discovery, interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node, CommandNode
from ros2cli.verb import VerbExtension

from ros2topic import qos, silence, topics

_ONE_WAIT = Duration(seconds=0.05)  # in which an interrupt is not heard
_ARRIVAL_TIMEOUT_SEC = 2.0  # a subscriber that stands still, or was killed, acknowledges nothing
_CLOCK_SEC = 2.0


class PubVerb(VerbExtension):
    """Publish a message to a topic."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_topic(parser, help="Name of the ROS topic to publish to (e.g. '/chatter')")
        arguments.add_type(
            parser, 'message_type', 'msg', help="Type of the ROS message (e.g. 'std_msgs/String')"
        )
        group = parser.add_mutually_exclusive_group()
        arguments.add_values(
            group,
            'values',
            'message_type',
            help='Values to fill the message with in YAML format (e.g. "data: Hello World"), '
            'otherwise the message will be published with default values',
        )
        arguments.add_flags(group, {'--stdin': 'Read values from standard input'})
        parser.add_argument(
            '-r',
            '--rate',
            metavar='N',
            type=arguments.positive_float,
            default=1.0,
            help='Publishing rate in Hz (default: 1)',
        )
        parser.add_argument(
            '-p',
            '--print',
            metavar='N',
            type=arguments.nonnegative_int,
            default=1,
            help='Only print every N-th published message (default: 1)',
        )
        group = parser.add_mutually_exclusive_group()
        arguments.add_flags(group, {'-1 --once': 'Publish one message and exit'})
        group.add_argument(
            '-t',
            '--times',
            type=arguments.nonnegative_int,
            default=0,
            help='Publish this number of times and then exit',
        )
        parser.add_argument(
            '-w',
            '--wait-matching-subscriptions',
            type=arguments.nonnegative_int,
            help='Wait until finding the specified number of matching subscriptions. Defaults to '
            '1 when using "-1"/"--once"/"--times", otherwise defaults to 0.',
        )
        parser.add_argument(
            '--max-wait-time-secs',
            type=arguments.positive_float,
            help='This sets the maximum wait time in seconds if --wait-matching-subscriptions is '
            'set. By default, this flag is not set meaning the subscriber will wait endlessly.',
        )
        parser.add_argument(
            '--keep-alive',
            metavar='N',
            type=arguments.nonnegative_float,
            default=0.1,
            help='Keep publishing node alive for N seconds after the last msg (default: 0.1)',
        )
        parser.add_argument('-n', '--node-name', help='Name of the created publishing node')
        qos.add_qos_arguments(parser, 'publish', 'default')
        discovery.add_direct_arguments(parser)

    def main(self, *, args: argparse.Namespace) -> None:
        times = 1 if args.once else args.times
        wanted = args.wait_matching_subscriptions
        if wanted is None:
            wanted = 1 if times else 0
        if args.max_wait_time_secs is not None and wanted == 0:
            raise CommandError(
                '--max-wait-time-secs option is only effective with '
                '--wait-matching-subscriptions, --once or --times'
            )
        message_class = interfaces.message(args.message_type)
        msg = message_class()
        stamps = interfaces.populate(
            msg,
            interfaces.yaml_mapping(sys.stdin.read() if args.stdin else args.values),
            expand_header_auto=True,
            expand_time_now=True,
        )
        with command_node(args, name=args.node_name) as node:
            publisher = node.node.create_publisher(
                message_class,
                topics.checked_name(args.topic_name),
                qos.profile(args),
                event_callbacks=PublisherEventCallbacks(incompatible_qos=_on_incompatible_qos),
            )
            silence.hint_when_not_received(publisher.topic_name)
            _wait_for_subscriptions(node, publisher, wanted, args.max_wait_time_secs)
            if args.use_sim_time and stamps:
                _wait_for_simulated_time(node)
            _publish(node, publisher, msg, stamps, times, args)


def _wait_for_subscriptions(
    node: CommandNode, publisher: Publisher, wanted: int, timeout_sec: float | None
) -> None:
    end = time.monotonic() + (timeout_sec or float('inf'))
    while publisher.get_subscription_count() < wanted:
        print(f'Waiting for at least {wanted} matching subscription(s)...')
        if time.monotonic() >= end:
            raise CommandError(
                f'Timed out waiting for subscribers: Expected {wanted} subcribers but only got '
                f'{publisher.get_subscription_count()} subscribers'
            )
        left = min(1.0, end - time.monotonic())
        node.spin_until(lambda: publisher.get_subscription_count() >= wanted, left)


def _wait_for_simulated_time(node: CommandNode) -> None:
    """Wait for /clock, before which the time is 0, for 2 s at most: a simulator may be paused."""
    clock = node.node.get_clock()
    if not node.spin_until(lambda: clock.now().nanoseconds > 0, _CLOCK_SEC):
        print('hint: no time has come on /clock, so that `now` and `auto` are 0', file=sys.stderr)


def _publish(
    node: CommandNode,
    publisher: Publisher,
    msg: Any,
    stamps: list[Callable[..., None]],
    times: int,
    args: argparse.Namespace,
) -> None:
    count = 0

    def publish() -> None:
        nonlocal count
        if times and count >= times:
            return
        now = node.node.get_clock().now().to_msg()
        for set_stamp in stamps:
            set_stamp(now)
        count += 1
        if args.print and count % args.print == 0:
            print(f'publishing #{count}: {msg!r}\n')
        publisher.publish(msg)

    print('publisher: beginning loop')
    publish()
    node.node.create_timer(1.0 / args.rate, publish)
    node.spin_until(lambda: bool(times and count >= times))
    # One that came after this node may find it a tenth of a second later than it was found.
    node.spin_until(lambda: publisher.wait_for_all_acked(_ONE_WAIT), _ARRIVAL_TIMEOUT_SEC)
    node.spin_until(lambda: False, args.keep_alive)


def _on_incompatible_qos(event: object) -> None:
    name = qos_policy_name_from_kind(event.last_policy_kind)  # type: ignore[attr-defined]
    print(f'Incompatible QoS Policy detected: {name}')
