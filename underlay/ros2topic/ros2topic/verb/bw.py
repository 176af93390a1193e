# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections import deque
import sys

from ros2cli import arguments, discovery
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2topic import measuring, topics

_UNITS = ((1e6, 'MB'), (1e3, 'KB'), (1.0, 'B'))


class BwVerb(VerbExtension):
    """Display bandwidth used by topic."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_direct_arguments(parser)
        arguments.add_topic(parser, help='Topic name to monitor for bandwidth utilization')
        measuring.add_window(parser, 100, 'maximum window size')

    def main(self, *, args: argparse.Namespace) -> None:
        topic = topics.find(args, args.topic_name, wait=True)
        samples: deque[tuple[float, int]] = deque(maxlen=args.window)
        with command_node(args) as node:
            clock = node.node.get_clock()

            def now_sec() -> float:
                return clock.now().nanoseconds * 1e-9

            def on_message(data: bytes) -> None:
                samples.append((now_sec(), len(data)))

            def report() -> None:
                now = now_sec()
                if samples and now < samples[0][0]:
                    print('WARNING: time is reset!', file=sys.stderr)
                    samples.clear()
                if len(samples) >= 2:
                    print(describe(list(samples), now))

            measuring.subscribe(node, topic, on_message, raw=True)
            print(f'Subscribed to [{topic.name}]')
            measuring.report_repeatedly(node, report, {topic.name: lambda: bool(samples)})


def describe(samples: list[tuple[float, int]], now_sec: float) -> str:
    """Describe what came, as pairs of arrival time and size in bytes."""
    sizes = [size for _, size in samples]
    rate = sum(sizes) / max(now_sec - samples[0][0], 1e-9)
    scale, unit = next((s, u) for s, u in _UNITS if rate >= s or s == 1.0)
    digits = 0 if unit == 'B' else 2

    def shown(number: float) -> str:
        return f'{number / scale:.{digits}f} {unit}'

    return (
        f'{shown(rate)}/s from {len(sizes)} messages\n'
        f'\tMessage size mean: {shown(sum(sizes) / len(sizes))} '
        f'min: {shown(min(sizes))} max: {shown(max(sizes))}'
    )
