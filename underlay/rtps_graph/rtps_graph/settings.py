# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the environment says of where to look for nodes: domain, range, peers."""

from __future__ import annotations

from dataclasses import dataclass
import os

LAST_DOMAIN = 101  # Beyond it lie the ports that Linux gives to anybody.
_RANGES = ('SUBNET', 'LOCALHOST', 'OFF', 'SYSTEM_DEFAULT')


@dataclass(frozen=True)
class Settings:
    """Where to look for nodes, as ROS 2's environment variables say it."""

    domain_id: int
    discovery_range: str
    static_peers: tuple[str, ...]


def settings_from_environment() -> Settings:
    """Read ROS_DOMAIN_ID and its companions.

    :raises ValueError: a variable holds what ROS 2 does not know.
    """
    text = os.environ.get('ROS_DOMAIN_ID') or '0'
    try:
        domain_id = int(text)
    except ValueError:
        domain_id = -1
    if not 0 <= domain_id <= 232:
        raise ValueError(
            f"ROS_DOMAIN_ID='{text}' is refused: a domain is a number from 0 to 232 "
            '(on Linux at best from 0 to 101); use `export ROS_DOMAIN_ID=0`'
        )
    discovery_range = os.environ.get('ROS_AUTOMATIC_DISCOVERY_RANGE') or 'SUBNET'
    if os.environ.get('ROS_LOCALHOST_ONLY') == '1':
        discovery_range = 'LOCALHOST'
    if discovery_range not in _RANGES:
        raise ValueError(
            f"ROS_AUTOMATIC_DISCOVERY_RANGE='{discovery_range}' is refused: allowed are "
            f'{", ".join(_RANGES)}'
        )
    peers = os.environ.get('ROS_STATIC_PEERS', '')
    return Settings(domain_id, discovery_range, tuple(p for p in peers.split(';') if p))
