# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections import Counter
from contextlib import suppress
import os
import re
import socket
import time
from typing import Any

from rclpy.qos import qos_profile_system_default
from ros2cli import arguments
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension
from ros2multicast.api import DEFAULT_GROUP, DEFAULT_PORT, open_receiver, open_sender
from std_msgs.msg import String

_LONGEST_DATAGRAM = 4096


class HelloVerb(VerbExtension):
    """Check network connectivity between multiple hosts.

    Called on each of several hosts, it says hello by a topic and by UDP multicast, and counts
    from whom it hears.
    """

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        parser.add_argument(
            '-t',
            '--topic',
            nargs='?',
            default='/canyouhearme',
            help="Name of ROS topic to publish to (default: '%(default)s')",
        )
        for short, name, default, text in (
            ('-ep', '--emit-period', 0.1, 'Time period to publish/send one message'),
            ('-pp', '--print-period', 1.0, 'Time period to print summary table'),
        ):
            parser.add_argument(
                short,
                name,
                metavar='N',
                type=arguments.positive_float,
                default=default,
                help=f'{text} (default: %(default)ss)',
            )
        parser.add_argument(
            '--ttl', type=arguments.positive_int, help='TTL for multicast send (default: None)'
        )
        arguments.add_flags(
            parser, {'-1 --once': 'Publish and multicast send for one emit period then exit'}
        )

    def main(self, *, args: argparse.Namespace, summary_table: SummaryTable | None = None) -> None:
        table = SummaryTable() if summary_table is None else summary_table
        with suppress(KeyboardInterrupt):
            _say_hello(args, table)


class SummaryTable:
    """Counts what was said, and what was heard from other hosts."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        self._pub = 0
        self._send = 0
        self._sub: dict[str, int] = Counter()
        self._receive: dict[str, int] = Counter()

    def increment_pub(self) -> None:
        self._pub += 1

    def increment_sub(self, hostname: str) -> None:
        self._sub[hostname] += 1

    def increment_send(self) -> None:
        self._send += 1

    def increment_receive(self, hostname: str) -> None:
        self._receive[hostname] += 1

    def format_print_summary(
        self,
        topic: str,
        print_period: float,
        *,
        group: str = DEFAULT_GROUP,
        port: int = DEFAULT_PORT,
    ) -> None:
        print('MULTIMACHINE COMMUNICATION SUMMARY')
        for said, heard, counts in (
            (f'Topic: {topic}, Published Msg Count: {self._pub}', 'Subscribed', self._sub),
            (
                f'Multicast Group/Port: {group}/{port}, Sent Msg Count: {self._send}',
                'Received',
                self._receive,
            ),
        ):
            print(f'{said}\n{heard} from:')
            print(f'{"":15} {"Hostname":20} Msg Count /{print_period}s')
            for hostname, count in counts.items():
                print(f'{"":15} {hostname:20} {count}')
        print('-' * 60)


def _say_hello(args: argparse.Namespace, table: SummaryTable) -> None:
    """Speak and listen until Ctrl-C, or for one period."""
    own = socket.gethostname()
    words = f"hello, it's me {own}"
    name = f'ros2doctor_{re.sub("[^0-9a-zA-Z_]", "_", own)}_{os.getpid()}_node'

    def on_hello(message: Any) -> None:
        if (hostname := _speaker(message.data)) != own:
            table.increment_sub(hostname)

    with command_node(args, name=name) as node, open_sender(args.ttl) as sender:
        publisher = node.node.create_publisher(String, args.topic, qos_profile_system_default)
        node.node.create_subscription(String, args.topic, on_hello, qos_profile_system_default)
        with open_receiver() as receiver:
            receiver.setblocking(False)
            printed = time.monotonic()
            while True:
                publisher.publish(String(data=words))
                table.increment_pub()
                sender.sendto(words.encode(), (DEFAULT_GROUP, DEFAULT_PORT))
                table.increment_send()
                node.spin_until(lambda: False, args.emit_period)
                for hostname in _heard(receiver):
                    if hostname != own:
                        table.increment_receive(hostname)
                if args.once or time.monotonic() - printed >= args.print_period:
                    table.format_print_summary(args.topic, args.print_period)
                    if args.once:
                        return
                    table.reset()
                    printed = time.monotonic()


def _heard(receiver: socket.socket) -> list[str]:
    """Take the hosts of the datagrams that have come."""
    found = []
    with suppress(BlockingIOError):
        while True:
            data, _ = receiver.recvfrom(_LONGEST_DATAGRAM)
            found.append(_speaker(data.decode(errors='replace')))
    return found


def _speaker(words: str) -> str:
    """Return the host that a hello ends with."""
    return words.split()[-1] if words.split() else ''
