# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
import math
from typing import Any

from rclpy.clock import Clock
from rclpy.qos import qos_profile_sensor_data
from ros2cli import completion, discovery
from ros2cli.arguments import positive_int
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2topic import expression, silence, topics

_WINDOW = 10000
_REPORT_SEC = 1.0


@dataclass
class Rate:
    """The times between messages, over a window."""

    window: int
    now_ns: Callable[[], int]
    intervals_ns: deque[int] = field(default_factory=deque)
    last_ns: int | None = None
    fresh: bool = False

    def __post_init__(self) -> None:
        self.intervals_ns = deque(maxlen=self.window)

    def on_message(self, _: Any = None) -> None:
        now = self.now_ns()
        if self.last_ns is not None and now < self.last_ns:
            print('time has reset, resetting counters')
            self.intervals_ns.clear()
            self.last_ns = None
        if self.last_ns is not None:
            self.intervals_ns.append(now - self.last_ns)
            self.fresh = True
        self.last_ns = now

    def has_begun(self) -> bool:
        return self.last_ns is not None

    def report(self) -> str | None:
        """Describe the rate; None while nothing new came."""
        if not self.fresh:
            return None
        self.fresh = False
        mean = sum(self.intervals_ns) / len(self.intervals_ns)
        spread = math.sqrt(
            sum((x - mean) ** 2 for x in self.intervals_ns) / len(self.intervals_ns)
        )
        return (
            f'average rate: {1e9 / mean if mean > 0 else 0.0:.3f}\n'
            f'\tmin: {min(self.intervals_ns) * 1e-9:.3f}s '
            f'max: {max(self.intervals_ns) * 1e-9:.3f}s '
            f'std dev: {spread * 1e-9:.5f}s window: {len(self.intervals_ns)}'
        )


class HzVerb(VerbExtension):
    """Print the average receiving rate to screen.

    Note: the rate is that of receiving. The platform's load and the quality of service may make it
    differ from the publisher's.
    """

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        completion.topic(
            parser.add_argument(
                'topic_name',
                nargs='+',
                help="Names of the ROS topic to listen to (e.g. '/chatter')",
            )
        )
        parser.add_argument(
            '--window',
            '-w',
            type=positive_int,
            default=_WINDOW,
            metavar='WINDOW',
            help='window size, in # of messages, for calculating rate (default: %(default)s)',
        )
        parser.add_argument(
            '--filter',
            dest='filter_expr',
            metavar='EXPR',
            help='only measure messages matching the specified Python expression',
        )
        parser.add_argument(
            '--wall-time',
            action='store_true',
            help='calculates rate using wall time which can be helpful when clock is not '
            'published during simulation',
        )

    def main(self, *, args: argparse.Namespace) -> None:
        keep = expression.message_filter(args.filter_expr)
        found = [topics.find(args, name, wait=True) for name in args.topic_name]
        with command_node(args) as node:
            clock = Clock() if args.wall_time else node.node.get_clock()
            rates = {}
            for topic in found:
                rate = Rate(args.window, lambda: clock.now().nanoseconds)
                rates[topic.name] = rate
                node.node.create_subscription(
                    topic.message_class,
                    topic.name,
                    lambda msg, rate=rate: rate.on_message() if keep(msg) else None,
                    qos_profile_sensor_data,
                    # Without a filter the message is not read.
                    raw=args.filter_expr is None,
                )
            if args.filter_expr is None:
                keep = expression.message_filter(None)

            def report() -> None:
                for name, rate in rates.items():
                    text = rate.report()
                    if text is not None:
                        print(text if len(rates) == 1 else f'{name}\n{text}')

            node.node.create_timer(_REPORT_SEC, report, clock=Clock())
            for name, rate in rates.items():
                silence.hint_when_silent(node, name, rate.has_begun)
            node.spin_until(lambda: False)
