# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which RTPS participants this host runs, told by the UDP ports that they have bound."""

from __future__ import annotations

import os
from pathlib import Path

# DDSI-RTPS 2.2, 9.6.1.1: port base, domain gain, participant gain and offsets.
_PORT_BASE, _DOMAIN_GAIN, _PARTICIPANT_GAIN, _UNICAST_OFFSET = 7400, 250, 2, 10
MAX_PARTICIPANTS = 120
MULTICAST_ADDRESS = '239.255.0.1'


def multicast_port(domain_id: int) -> int:
    return _PORT_BASE + _DOMAIN_GAIN * domain_id


def discovery_ports(domain_id: int) -> range:
    """Every port at which a participant of the domain may listen for discovery."""
    first = multicast_port(domain_id) + _UNICAST_OFFSET
    return range(first, first + _PARTICIPANT_GAIN * MAX_PARTICIPANTS, _PARTICIPANT_GAIN)


def participant_ports(domain_id: int, bound: set[int]) -> set[int]:
    """Tell which of the UDP ports that are bound on this host are discovery ports of a domain.

    A participant binds two neighbouring ports, for discovery and for data, which tells it from
    other programs.
    """
    return {port for port in discovery_ports(domain_id) if {port, port + 1} <= bound}


def bound_udp_ports(*, own: bool = False) -> set[int] | None:
    """Return the UDP ports that are bound on this host (or `own`: by this user's processes).

    None where the kernel does not say.
    """
    ports: set[int] = set()
    found = False
    for table in ('/proc/net/udp', '/proc/net/udp6'):
        try:
            lines = Path(table).read_text(encoding='ascii').splitlines()[1:]
        except OSError:
            continue
        found = True
        for columns in map(str.split, lines):
            # local address:port is the second column, the user id the eighth (proc(5)).
            if not own or int(columns[7]) == os.getuid():
                ports.add(int(columns[1].rpartition(':')[2], 16))
    return ports if found else None
