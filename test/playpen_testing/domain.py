# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Choose a DDS domain in which no participant of this machine lives."""

import os
from pathlib import Path

PORT_BASE = 7400  # RTPS 2.5, 9.6.2.3: PB, DG; a participant binds PB + DG * domain + 10 + 2 * n
DOMAIN_GAIN = 250
LAST_DOMAIN = 101  # higher ones reach into the ports that Linux hands out by itself

_next = os.getpid() % LAST_DOMAIN


def _bound_udp_ports() -> set[int]:
    rows = [
        row.split()
        for table in ('/proc/net/udp', '/proc/net/udp6')
        if Path(table).exists()
        for row in Path(table).read_text().splitlines()[1:]
    ]
    return {int(row[1].rsplit(':', 1)[1], 16) for row in rows}


def free_domain_id() -> int:
    """
    Return a domain id that this call never returned before and that nobody uses.

    :returns: 1 to 101.
    :raises RuntimeError: if every domain is in use.
    """
    global _next  # noqa: PLW0603
    ports = _bound_udp_ports()
    for _ in range(LAST_DOMAIN):
        _next = _next % LAST_DOMAIN + 1
        first = PORT_BASE + DOMAIN_GAIN * _next
        if not ports.intersection(range(first, first + DOMAIN_GAIN)):
            return _next
    raise RuntimeError(f'all domains 1 to {LAST_DOMAIN} are in use: end the ROS nodes left over')
