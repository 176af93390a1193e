# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read the graph as the environment asks for it: domain, range, peers."""

from __future__ import annotations

import argparse
import sys

from rtps_graph import graph
from rtps_graph.observer import Observer
from rtps_graph.settings import Settings

from ros2cli.settings import settings_from_environment

DEFAULT_TIMEOUT_SEC = 3.0
DEFAULT_SPIN_TIME_SEC = 0.5


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add upstream's options of a verb that looks at the graph."""
    parser.add_argument(
        '--spin-time',
        type=float,
        default=DEFAULT_SPIN_TIME_SEC,
        help='Spin time in seconds to wait for discovery of other hosts; the nodes of this host '
        'are counted, so that nothing has to be waited for',
    )
    parser.add_argument(
        '-s', '--use-sim-time', action='store_true', help='Enable ROS simulation time'
    )
    parser.add_argument(
        '--no-daemon', action='store_true', help='Accepted; there is no daemon: graphs are exact'
    )


def read_graph(args: argparse.Namespace | None = None, *, quiet: bool = False) -> graph.Graph:
    """Read the graph of the domain; unless `quiet`, hints on stderr where it is empty."""
    settings = settings_from_environment()
    if settings.discovery_range == 'OFF':
        if not quiet:
            print(
                'hint: ROS_AUTOMATIC_DISCOVERY_RANGE=OFF, so that nothing is discovered; '
                '`export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST` shows the nodes of this machine',
                file=sys.stderr,
            )
        return graph.Graph([], [])
    settle_sec = max(0.0, getattr(args, 'spin_time', DEFAULT_SPIN_TIME_SEC))
    with Observer(
        domain_id=settings.domain_id,
        subnet=settings.discovery_range != 'LOCALHOST',
        static_peers=settings.static_peers,
    ) as observer:
        observer.observe(
            timeout_sec=max(DEFAULT_TIMEOUT_SEC, settle_sec + 1.0), settle_sec=settle_sec
        )
        found = graph.build(observer.participants.values(), observer.unanswered)
    if not quiet:
        _print_hints(settings, found)
    return found


def _print_hints(settings: Settings, found: graph.Graph) -> None:
    from ros2_diagnosis import nodes, places

    findings = list(nodes.check_silent(found, settings.domain_id))
    if not found.nodes:
        # The nodes may run in another domain.
        findings += places.check_domains(settings, here=0)
    for finding in findings:
        print(f'hint: {finding}', file=sys.stderr)
