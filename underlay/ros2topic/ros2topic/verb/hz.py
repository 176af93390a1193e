# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rclpy.clock import Clock
from ros2cli import arguments, discovery
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2topic import expression, measuring, topics


@dataclass
class Rate:
    """The times between messages, over a window."""

    now_ns: Callable[[], int]
    keep: Callable[[Any], bool]
    intervals_ns: deque[int]
    last_ns: int | None = None
    fresh: bool = False
    dropped: int = 0

    def on_message(self, msg: Any) -> None:
        if not self.keep(msg):
            self.dropped += 1
            return
        now = self.now_ns()
        if now == 0:
            return  # simulated time that has not begun
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
        mean, spread = measuring.mean_and_spread(self.intervals_ns)
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
        discovery.add_direct_arguments(parser)
        arguments.add_topic(
            parser, nargs='+', help="Names of the ROS topic to listen to (e.g. '/chatter')"
        )
        measuring.add_window(parser, 10000)
        parser.add_argument(
            '--filter',
            dest='filter_expr',
            metavar='EXPR',
            help='only measure messages matching the specified Python expression',
        )
        arguments.add_flags(
            parser,
            {
                '--wall-time': 'calculates rate using wall time which can be helpful when clock '
                'is not published during simulation'
            },
        )

    def main(self, *, args: argparse.Namespace) -> None:
        keep = expression.message_filter(args.filter_expr)
        found = [topics.find(args, name, wait=True) for name in args.topic_name]
        with command_node(args) as node:
            clock = Clock() if args.wall_time else node.node.get_clock()
            rates = {}
            for topic in found:
                rate = Rate(lambda: clock.now().nanoseconds, keep, deque(maxlen=args.window))
                rates[topic.name] = rate
                # Without a filter the message is not read.
                measuring.subscribe(node, topic, rate.on_message, raw=args.filter_expr is None)

            def report() -> None:
                for name, rate in rates.items():
                    text = rate.report()
                    if text is not None:
                        print(text if len(rates) == 1 else f'{name}\n{text}')

            begun = {name: rate.has_begun for name, rate in rates.items()}
            measuring.report_repeatedly(
                node, report, begun, dropped=lambda name: rates[name].dropped, clock=clock
            )
