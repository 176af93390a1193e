# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What talker_qos and listener_qos share: their options, and their end."""

from __future__ import annotations

import argparse
from collections.abc import Callable
import sys
from typing import TypeVar

from node_program import in_steps, own_words, run_node, Spinner
from rclpy.qos import qos_profile_sensor_data, QoSProfile, ReliabilityPolicy

from demo_nodes_py.topics.listener import Listener
from demo_nodes_py.topics.talker import Talker

Counting = TypeVar('Counting', Talker, Listener)


def run_cycles(
    make: Callable[[QoSProfile], Counting], argv: list[str] | None, program: str, counted: str
) -> int:
    """
    Run a node until it has counted as many messages as the command line says.

    :param argv: the words after the program's name, None for those of this process.
    """
    words: list[str] = sys.argv[1:] if argv is None else argv
    parser = argparse.ArgumentParser(
        prog=program, formatter_class=argparse.ArgumentDefaultsHelpFormatter
    )
    parser.add_argument('--reliable', action='store_true', help='no message may be lost')
    parser.add_argument('-n', '--number_of_cycles', type=int, default=20, help=counted)
    options = parser.parse_args(own_words([program, *words]))
    reliable = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
    qos = reliable if options.reliable else qos_profile_sensor_data

    def steps(node: Counting, spinner: Spinner) -> int:
        spinner.until(lambda: node.count >= options.number_of_cycles)
        return 0

    return run_node(lambda _: make(qos), words, in_steps(steps))


def reliability_of(qos: QoSProfile) -> str:
    return 'Reliable' if qos.reliability == ReliabilityPolicy.RELIABLE else 'Best effort'
