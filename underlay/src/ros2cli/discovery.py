# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read the graph as the environment asks for it: domain, range, peers."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
import os
import sys

from ros2cli import graph
from ros2cli.errors import CommandError
from ros2cli.rtps.observer import Observer

DEFAULT_TIMEOUT_SEC = 3.0
DEFAULT_SPIN_TIME_SEC = 0.5
_RANGES = ('SUBNET', 'LOCALHOST', 'OFF', 'SYSTEM_DEFAULT')


@dataclass(frozen=True)
class Settings:
    """Where to look for nodes, as ROS 2's environment variables say it."""

    domain_id: int
    discovery_range: str
    static_peers: tuple[str, ...]


def settings_from_environment() -> Settings:
    """Read ROS_DOMAIN_ID and its companions.

    :raises CommandError: a variable holds what ROS 2 does not know.
    """
    text = os.environ.get('ROS_DOMAIN_ID') or '0'
    try:
        domain_id = int(text)
    except ValueError:
        domain_id = -1
    if not 0 <= domain_id <= 232:
        raise CommandError(
            f"ROS_DOMAIN_ID='{text}' is refused: a domain is a number from 0 to 232 "
            '(on Linux at best from 0 to 101); use `export ROS_DOMAIN_ID=0`'
        )
    discovery_range = os.environ.get('ROS_AUTOMATIC_DISCOVERY_RANGE') or 'SUBNET'
    if os.environ.get('ROS_LOCALHOST_ONLY') == '1':
        discovery_range = 'LOCALHOST'
    if discovery_range not in _RANGES:
        raise CommandError(
            f"ROS_AUTOMATIC_DISCOVERY_RANGE='{discovery_range}' is refused: allowed are "
            f'{", ".join(_RANGES)}'
        )
    peers = os.environ.get('ROS_STATIC_PEERS', '')
    return Settings(domain_id, discovery_range, tuple(p for p in peers.split(';') if p))


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
    """Read the graph of the domain; unless `quiet`, with a line on stderr where it says little."""
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
    from ros2cli.diagnosis import nodes, places

    findings = list(nodes.check_silent(found, settings.domain_id))
    if not found.nodes:
        # Somebody who sees nothing looks for what runs: it may run next door.
        findings += places.check_domains(settings, here=0)
    for finding in findings:
        print(f'hint: {finding}', file=sys.stderr)
