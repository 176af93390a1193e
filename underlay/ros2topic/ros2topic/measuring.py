# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the verbs that measure a topic have alike: hz, bw and delay."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection
from functools import partial
import math
from typing import Any

from rclpy.clock import Clock
from rclpy.qos import qos_profile_sensor_data
from ros2cli import arguments
from ros2cli.node.direct import CommandNode

from ros2topic import silence
from ros2topic.topics import Topic

_REPORT_SEC = 1.0


def add_window(parser: argparse.ArgumentParser, default: int, what: str = 'window size') -> None:
    parser.add_argument(
        '--window',
        '-w',
        type=arguments.positive_int,
        default=default,
        metavar='WINDOW',
        help=f'{what}, in # of messages, for calculating rate (default: %(default)s)',
    )


def mean_and_spread(values: Collection[float]) -> tuple[float, float]:
    """Return the mean and the standard deviation.

    Those of the module statistics take 20 ms for a full window, in which nothing is received.
    """
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((value - mean) ** 2 for value in values) / len(values))


def subscribe(
    node: CommandNode, topic: Topic, on_message: Callable[[Any], None], *, raw: bool = False
) -> None:
    node.node.create_subscription(
        topic.message_class, topic.name, on_message, qos_profile_sensor_data, raw=raw
    )


def report_repeatedly(
    node: CommandNode,
    report: Callable[[], None],
    begun: dict[str, Callable[[], bool]],
    *,
    dropped: Callable[[str], int] = lambda _: 0,
    clock: Clock | None = None,
) -> None:
    """Report every second of a clock, the node's where none is given, until Ctrl-C.

    :param begun: tells whether something has come, by topic; where that takes long, why not is
        printed.
    :param dropped: tells how many messages of a topic a filter did not let pass.
    """
    node.node.create_timer(_REPORT_SEC, report, clock=clock)
    for name, has_begun in begun.items():
        silence.hint_when_silent(node, name, has_begun, partial(dropped, name))
    node.spin_until(lambda: False)
