# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections import deque
import math
from typing import Any

from rclpy.clock import Clock
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from ros2cli import completion, discovery
from ros2cli.arguments import positive_int
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2topic import silence, topics

_WINDOW = 10000


class DelayVerb(VerbExtension):
    """Display delay of topic from timestamp in header."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        completion.topic(
            parser.add_argument('topic_name', help='Topic name to calculate the delay for')
        )
        parser.add_argument(
            '--window',
            '-w',
            type=positive_int,
            default=_WINDOW,
            metavar='WINDOW',
            help='window size, in # of messages, for calculating rate (default: %(default)s)',
        )

    def main(self, *, args: argparse.Namespace) -> None:
        topic = topics.find(args, args.topic_name, wait=True)
        if 'header' not in topic.message_class.get_fields_and_field_types():
            raise CommandError('msg does not have header')
        delays_sec: deque[float] = deque(maxlen=args.window)
        fresh = False
        with command_node(args) as node:
            clock = node.node.get_clock()

            def on_message(msg: Any) -> None:
                nonlocal fresh
                stamp = Time.from_msg(msg.header.stamp).nanoseconds
                delays_sec.append((clock.now().nanoseconds - stamp) * 1e-9)
                fresh = True

            def report() -> None:
                nonlocal fresh
                if fresh:
                    print(describe(list(delays_sec)))
                    fresh = False

            node.node.create_subscription(
                topic.message_class, topic.name, on_message, qos_profile_sensor_data
            )
            node.node.create_timer(1.0, report, clock=Clock())
            silence.hint_when_silent(node, topic.name, lambda: bool(delays_sec))
            node.spin_until(lambda: False)


def describe(delays_sec: list[float]) -> str:
    mean = sum(delays_sec) / len(delays_sec)
    spread = math.sqrt(sum((x - mean) ** 2 for x in delays_sec) / len(delays_sec))
    return (
        f'average delay: {mean:.3f}\n\tmin: {min(delays_sec):.3f}s max: {max(delays_sec):.3f}s '
        f'std dev: {spread:.5f}s window: {len(delays_sec)}'
    )
