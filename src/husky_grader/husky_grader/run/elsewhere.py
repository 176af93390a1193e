# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Another DDS domain in which a program is, by the UDP ports that it has bound."""

from contextlib import suppress
from pathlib import Path
import socket

# DDSI-RTPS 2.2, 9.6.1.1: port base, domain gain, offset of the first participant, each two apart.
_PORT_BASE, _DOMAIN_GAIN, _FIRST_PORT = 7400, 250, 10
_LAST_DOMAIN = 232
_ADDRESS = 1  # the column of /proc/net/udp, see proc(5)


def domain_elsewhere(domain_id: int) -> int | None:
    """
    Return a domain besides `domain_id` that has participants in this network; None if none has.

    None also where the network is not the jail's own, in which there is the loopback alone: those
    in it may be anybody's.
    """
    if [name for _, name in socket.if_nameindex()] != ['lo']:
        return None
    bound: set[int] = set()
    for table in ('/proc/net/udp', '/proc/net/udp6'):
        with suppress(OSError):  # not Linux, or no IPv6
            lines = Path(table).read_text(encoding='ascii').splitlines()[1:]
            bound |= {int(line.split()[_ADDRESS].rpartition(':')[2], 16) for line in lines}
    domains = (_domain_of(port) for port in sorted(bound) if port + 1 in bound)
    return next((each for each in domains if each not in (None, domain_id)), None)


def _domain_of(port: int) -> int | None:
    """Return the domain for whose discovery a port may be; the next one is for data."""
    domain_id, offset = divmod(port - _PORT_BASE, _DOMAIN_GAIN)
    is_discovery = offset >= _FIRST_PORT and offset % 2 == 0 and 0 <= domain_id <= _LAST_DOMAIN
    return domain_id if is_discovery else None
