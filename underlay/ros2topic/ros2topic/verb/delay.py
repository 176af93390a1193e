# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections import deque
import sys
from typing import Any

from rclpy.time import Time
from ros2cli import arguments, discovery
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2topic import measuring, topics

_MAKES_SENSE_SEC = 86400.0


class DelayVerb(VerbExtension):
    """Display delay of topic from timestamp in header."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_direct_arguments(parser)
        arguments.add_topic(parser, help='Topic name to calculate the delay for')
        measuring.add_window(parser, 10000)

    def main(self, *, args: argparse.Namespace) -> None:
        topic = topics.find(args, args.topic_name, wait=True)
        if 'header' not in topic.message_class.get_fields_and_field_types():
            raise CommandError('msg does not have header')
        delays_sec: deque[float] = deque(maxlen=args.window)
        fresh = False
        explained = False
        stamp = 0
        with command_node(args) as node:
            clock = node.node.get_clock()

            def on_message(msg: Any) -> None:
                nonlocal fresh, stamp
                if clock.now().nanoseconds == 0:
                    return  # simulated time that has not begun
                stamp = Time.from_msg(msg.header.stamp).nanoseconds
                delays_sec.append((clock.now().nanoseconds - stamp) * 1e-9)
                fresh = True

            def report() -> None:
                nonlocal fresh, explained
                if not explained and delays_sec and abs(delays_sec[-1]) > _MAKES_SENSE_SEC:
                    explained = True
                    has_clock = node.node.count_publishers('/clock') > 0
                    _explain(stamp, by_clock=args.use_sim_time, has_clock=has_clock)
                if fresh:
                    print(describe(list(delays_sec)))
                    fresh = False
                elif delays_sec:
                    print('no new messages')

            measuring.subscribe(node, topic, on_message)
            measuring.report_repeatedly(node, report, {topic.name: lambda: bool(delays_sec)})


def _explain(stamp: int, *, by_clock: bool, has_clock: bool) -> None:
    """Say why a delay makes no sense, where that is known.

    :param by_clock: it is measured by the time of /clock.
    """
    if stamp == 0:
        why = 'its header.stamp is 0: set it to `get_clock().now().to_msg()`'
    elif by_clock:
        why = 'its stamps are not of the time of /clock: leave out --use-sim-time'
    elif has_clock:
        why = 'its stamps are of the time of /clock: --use-sim-time measures by that'
    else:
        return
    print(f'hint: {why}', file=sys.stderr)


def describe(delays_sec: list[float]) -> str:
    mean, spread = measuring.mean_and_spread(delays_sec)
    return (
        f'average delay: {mean:.3f}\n\tmin: {min(delays_sec):.3f}s max: {max(delays_sec):.3f}s '
        f'std dev: {spread:.5f}s window: {len(delays_sec)}'
    )
