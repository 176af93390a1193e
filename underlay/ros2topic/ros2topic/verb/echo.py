# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections.abc import Callable
import sys
from typing import Any

from rclpy.event_handler import SubscriptionEventCallbacks
from ros2cli import arguments, discovery
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2topic import expression, printing, qos, silence, topics


class EchoVerb(VerbExtension):
    """Output messages from a topic."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_topic(parser, help="Name of the ROS topic to listen to (e.g. '/chatter')")
        arguments.add_type(
            parser,
            'message_type',
            'msg',
            nargs='?',
            help="Type of the ROS message (e.g. 'std_msgs/msg/String')",
        )
        qos.add_qos_arguments(parser, 'subscribe', 'sensor_data')
        printing.add_arguments(parser)
        parser.add_argument(
            '--field', help='Echo a selected field of a message. Use "." to select sub-fields'
        )
        arguments.add_flags(
            parser,
            {
                '--no-lost-messages': "Don't report when a message is lost",
                '--raw': 'Echo the raw binary representation',
            },
        )
        parser.add_argument(
            '--filter',
            dest='filter_expr',
            metavar='FILTER',
            help='Python expression to filter messages that are printed. Expression can use '
            'Python builtins as well as m (the message).',
        )
        arguments.add_flags(parser, {'--once': 'Print the first message received and then exit.'})
        parser.add_argument(
            '--timeout',
            metavar='N',
            type=arguments.nonnegative_float,
            help='Set a timeout in seconds for waiting for a message',
        )
        arguments.add_flags(
            parser, {'--include-message-info -i': 'Shows the associated message info.'}
        )

    def main(self, *, args: argparse.Namespace) -> None:
        keep = expression.message_filter(args.filter_expr)
        path = _path(args.field)
        topic = topics.find(args, args.topic_name, type_name=args.message_type)
        shown = 0
        arrived = False

        def on_message(msg: Any, info: Any) -> None:
            nonlocal shown, arrived
            arrived = True
            value = _field(msg, path)
            if (args.once and shown) or not keep(value):
                return
            printing.show(value, args, info if args.include_message_info else None)
            shown += 1

        with command_node(args) as node:
            node.node.create_subscription(
                topic.message_class,
                topic.name,
                on_message,
                qos.profile_for(args, topic.publishers),
                event_callbacks=SubscriptionEventCallbacks(message_lost=_on_lost(args)),
                raw=args.raw,
            )
            if args.timeout is None:
                silence.hint_when_silent(node, topic.name, lambda: arrived)
            node.spin_until(lambda: bool(args.once and shown), args.timeout)


def _on_lost(args: argparse.Namespace) -> Callable[[Any], None] | None:
    if args.no_lost_messages:
        return None

    def report(status: Any) -> None:
        print(
            'A message was lost!!!\n\ttotal count change:'
            f'{status.total_count_change}\n\ttotal count: {status.total_count}---',
            file=sys.stderr,
        )

    return report


def _path(field: str | None) -> list[str]:
    path = [name for name in (field or '').split('.') if name]
    if field is not None and not path:
        raise CommandError(f"Invalid field value '{field}'")
    return path


def _field(msg: Any, path: list[str]) -> Any:
    value = msg
    for name in path:
        try:
            value = getattr(value, name)
        except AttributeError as error:
            raise CommandError(
                f"Invalid field '{'.'.join(path)}': {error}{_fields_of(value)}"
            ) from None
    return value


def _fields_of(value: Any) -> str:
    if not hasattr(value, 'get_fields_and_field_types'):
        return ''
    return f'; there is {", ".join(value.get_fields_and_field_types())}'
