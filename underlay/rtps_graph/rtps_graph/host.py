# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which RTPS participants this host runs, told by the UDP ports that they have bound."""

from __future__ import annotations

from collections.abc import Collection
import contextlib
import mmap
import os
from pathlib import Path
import pwd
from typing import NamedTuple

# DDSI-RTPS 2.2, 9.6.1.1: port base, domain gain, participant gain and offsets.
_PORT_BASE, _DOMAIN_GAIN, _PARTICIPANT_GAIN, _UNICAST_OFFSET = 7400, 250, 2, 10
MAX_PARTICIPANTS = 120
MULTICAST_ADDRESS = '239.255.0.1'
_ADDRESS, _USER, _INODE = 1, 7, 9  # the columns of /proc/net/udp, see proc(5)
_QUIET_READS, _MOST_READS = 3, 12
_SHARED_MEMORY = Path('/dev/shm')


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
    sockets = _udp_sockets()
    if sockets is None:
        return None
    return {each.port for each in sockets if not own or each.user == os.getuid()}


def stopped_ports(ports: Collection[int]) -> set[int]:
    """Tell which UDP ports belong to a process that is stopped, by Ctrl-Z or a debugger.

    The processes of other users are not looked at.
    """
    stopped: set[int] = set()
    for process in Path('/proc').glob('[0-9]*'):
        with contextlib.suppress(OSError):  # it has ended, or is another user's
            state = (process / 'stat').read_text(errors='replace').rpartition(')')[2].split()[0]
            if state in 'Tt':
                stopped |= ports_of(process)
    return stopped & set(ports)


def ports_of(process: Path) -> set[int]:
    """Return the UDP ports that a process has bound.

    :param process: its folder in /proc.
    :raises OSError: it has ended, or is another user's.
    """
    opened = set(map(os.readlink, (process / 'fd').iterdir()))
    sockets = _udp_sockets() or ()
    return {each.port for each in sockets if f'socket:[{each.inode}]' in opened}


def process_at(port: int) -> Path | None:
    """Return the folder in /proc of this user's process that has bound a UDP port."""
    sockets = {f'socket:[{each.inode}]' for each in _udp_sockets() or () if each.port == port}
    for process in Path('/proc').glob('[0-9]*'):
        with contextlib.suppress(OSError):  # it has ended, or is another user's
            if sockets & set(map(os.readlink, (process / 'fd').iterdir())):
                return process
    return None


class ForeignMemory(NamedTuple):
    """Shared memory of a participant of this host to which no message of this user comes.

    Fast DDS sends nothing by another way to a participant of the same host.
    """

    owner: str  # the name of another user, or his number; '' where the memory is not here


def foreign_memory(port: int) -> ForeignMemory | None:
    """Look at the shared memory that a participant of this host announces, by its port."""
    try:
        owner = (_SHARED_MEMORY / f'fastrtps_port{port}').stat().st_uid
    except FileNotFoundError:
        return ForeignMemory('') if _SHARED_MEMORY.is_dir() else None
    return None if owner == os.getuid() else ForeignMemory(_user_name(owner))


def _user_name(user: int) -> str:
    try:
        return pwd.getpwuid(user).pw_name
    except KeyError:  # as in a container
        return str(user)


class _Socket(NamedTuple):
    port: int
    user: int
    inode: int


def _udp_sockets() -> set[_Socket] | None:
    """Return the UDP sockets of this host; None where the kernel does not tell of them."""
    sockets: set[_Socket] | None = None
    for table in ('/proc/net/udp', '/proc/net/udp6'):
        with contextlib.suppress(OSError):
            sockets = (sockets or set()) | _read_whole(Path(table))
    return sockets


def _read_whole(table: Path) -> set[_Socket]:
    """
    Return every socket that is there all the while, and some that are not.

    The kernel hands out a page at a time, and goes on with the n-th socket: where one before that
    is closed meanwhile, another is left out. So more than a page is read until nothing new comes.
    """
    sockets: set[_Socket] = set()
    quiet = 0
    for _ in range(_MOST_READS):
        text = table.read_text(encoding='ascii')
        new = set(map(_socket, text.splitlines()[1:])) - sockets
        sockets |= new
        quiet = 0 if new else quiet + 1
        if quiet == _QUIET_READS or len(text) <= mmap.PAGESIZE:
            break
    return sockets


def _socket(line: str) -> _Socket:
    columns = line.split()
    port = int(columns[_ADDRESS].rpartition(':')[2], 16)
    return _Socket(port, int(columns[_USER]), int(columns[_INODE]))
