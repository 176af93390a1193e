# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections import deque
from typing import Any

from rclpy.time import Time
from ros2cli import arguments, discovery
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2topic import measuring, topics


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
        with command_node(args) as node:
            clock = node.node.get_clock()

            def on_message(msg: Any) -> None:
                nonlocal fresh
                if clock.now().nanoseconds == 0:
                    return  # simulated time that has not begun
                stamp = Time.from_msg(msg.header.stamp).nanoseconds
                delays_sec.append((clock.now().nanoseconds - stamp) * 1e-9)
                fresh = True

            def report() -> None:
                nonlocal fresh
                if fresh:
                    print(describe(list(delays_sec)))
                    fresh = False
                elif delays_sec:
                    print('no new messages')

            measuring.subscribe(node, topic, on_message)
            measuring.report_repeatedly(node, report, {topic.name: lambda: bool(delays_sec)})


def describe(delays_sec: list[float]) -> str:
    mean, spread = measuring.mean_and_spread(delays_sec)
    return (
        f'average delay: {mean:.3f}\n\tmin: {min(delays_sec):.3f}s max: {max(delays_sec):.3f}s '
        f'std dev: {spread:.5f}s window: {len(delays_sec)}'
    )
