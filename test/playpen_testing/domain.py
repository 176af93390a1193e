# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Choose a DDS domain in which no participant of this machine lives."""

import os
from pathlib import Path

PORT_BASE = 7400  # RTPS 2.5, 9.6.2.3: PB, DG; a participant binds PB + DG * domain + 10 + 2 * n
DOMAIN_GAIN = 250

# Two processes run tests of this folder: those in the browser, and the others.
_WORKER = int(os.environ.get('PYTEST_XDIST_WORKER', 'gw0').removeprefix('gw'))
DOMAINS = range(1, 15) if _WORKER % 2 == 0 else range(15, 30)

_next = os.getpid()


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
    Return a domain id that this call did not return lately and that nobody uses.

    :returns: 1 to 29, see conftest.py in the uppermost folder.
    :raises RuntimeError: if every domain is in use.
    """
    global _next  # noqa: PLW0603
    ports = _bound_udp_ports()
    for _ in DOMAINS:
        _next += 1
        domain = DOMAINS[_next % len(DOMAINS)]
        first = PORT_BASE + DOMAIN_GAIN * domain
        if not ports.intersection(range(first, first + DOMAIN_GAIN)):
            return domain
    raise RuntimeError(f'the domains {DOMAINS} are in use: end the ROS nodes left over')
