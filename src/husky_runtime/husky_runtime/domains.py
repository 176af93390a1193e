# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
DDS domains: one for each run, and at most one simulator in each.

Both are locks. A lock is a name that the kernel gives to one process at a time: that of a Unix
socket in the abstract namespace (unix(7)). It ends with its process, leaves no file behind, and
holds for every user of the machine within one network namespace, as DDS discovery does. Other
systems than Linux use a locked file.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from io import FileIO
import os
from pathlib import Path
import socket
import struct
import sys
import tempfile
import weakref

# Domains that a run may take for itself. The first 30 are left to people; from 102 on the ports
# are those that Linux gives to any program (ip_local_port_range).
DOMAINS = range(30, 102)

NO_OTHER_WAY = {'ROS_DISCOVERY_SERVER': '', 'ROS_STATIC_PEERS': '', 'ROS_LOCALHOST_ONLY': ''}
"""Variables of a run whose nodes find each other by themselves, and nobody elsewhere."""

_LOOPBACK = '127.0.0.1'
_PORT_BASE, _DOMAIN_GAIN = 7400, 250  # OMG DDSI-RTPS 2.2, 9.6.1.1: PB, DG
_MOST_PARTICIPANTS = 20  # of a domain that are looked for
_BACKLOG = 4096  # connections, never accepted, of those that ask for the holder


class DomainError(ValueError):
    """No DDS domain can be used, or not this one; the message is one line for a person."""


class Lock:
    """A name that one process of this machine holds, until it releases it or ends."""

    def __init__(self, name: str) -> None:
        """
        Take the lock.

        :raises BlockingIOError: if another process holds it.
        """
        try:
            held = _bind(name) if sys.platform == 'linux' else _lock_file(name)
        except OSError:
            raise BlockingIOError(f'{name} is held by another process') from None
        self._release = weakref.finalize(self, held.close)  # also at garbage collection

    def close(self) -> None:
        """Release the name; may be called twice."""
        self._release()


class OwnDomain:
    """A DDS domain without participants, for this run alone; a context manager."""

    def __init__(self) -> None:
        """
        Take one.

        :raises DomainError: if every domain is taken, or nodes of this computer cannot meet.
        """
        check_loopback()
        # Not the domain of the run before: its processes may still be ending.
        first = os.getpid() % len(DOMAINS)
        for number in (*DOMAINS[first:], *DOMAINS[:first]):
            try:
                lock = Lock(f'ros_domain_{number}')
            except BlockingIOError:
                continue
            if not _has_participants(number):
                self.number, self._lock = number, lock
                return
            lock.close()
        raise DomainError(
            f'all {len(DOMAINS)} DDS domains for runs of their own are taken: end runs that are '
            'left over, or set ROS_DOMAIN_ID to a domain in which nobody is'
        )

    @property
    def environment(self) -> dict[str, str]:
        """Return the variables by which nodes are in it, and find each other."""
        return {'ROS_DOMAIN_ID': str(self.number), **range_of_a_run(), **NO_OTHER_WAY}

    def close(self) -> None:
        """Release the domain; may be called twice."""
        self._lock.close()

    def __enter__(self) -> 'OwnDomain':
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def range_of_a_run() -> dict[str, str]:
    """Return the variable of the discovery range; the user's, but for OFF: nodes must meet."""
    name = 'ROS_AUTOMATIC_DISCOVERY_RANGE'
    wanted = os.environ.get(name) or 'OFF'
    return {name: 'LOCALHOST' if wanted == 'OFF' else wanted}


def check_loopback() -> None:
    """
    Check that processes of this computer reach each other by UDP, as DDS does.

    :raises DomainError: if they do not: in some containers and sandboxes nobody has set it up.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
        try:
            own.bind((_LOOPBACK, 0))
            own.connect(own.getsockname())
        except OSError as error:
            raise DomainError(
                f'processes of this computer cannot meet at {_LOOPBACK} ({error.strerror}): its '
                'loopback interface is not set up; on Linux `ip link set lo up` does it'
            ) from None


@contextmanager
def in_own_domain() -> Iterator[int]:
    """Put this process, and what it starts meanwhile, into a domain of its own."""
    with OwnDomain() as domain:
        before = {name: os.environ.get(name) for name in domain.environment}
        os.environ.update(domain.environment)
        try:
            yield domain.number
        finally:
            for name, value in before.items():
                if value is None:
                    os.environ.pop(name)
                else:
                    os.environ[name] = value


def lock_simulator(domain: int) -> Lock:
    """
    Take the lock of the one simulator of a domain: two would publish the same topics.

    :raises DomainError: if there is one already.
    """
    name = f'husky_sim_in_ros_domain_{domain}'
    try:
        return Lock(name)
    except BlockingIOError:
        raise DomainError(
            f'another simulator runs in ROS domain {domain}: {_holder(name)}; end it, or give '
            f'this one a domain of its own, as in `export ROS_DOMAIN_ID={(domain + 1) % 30}`'
        ) from None


def _bind(name: str) -> socket.socket | FileIO:
    holder = socket.socket(socket.AF_UNIX)
    try:
        holder.bind(f'\0{name}')
        holder.listen(_BACKLOG)
    except OSError:
        holder.close()
        raise
    return holder


def _lock_file(name: str) -> socket.socket | FileIO:
    import fcntl  # not on every system

    file = FileIO(Path(tempfile.gettempdir(), f'{name}.lock'), 'w')
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        file.close()
        raise
    return file


def _holder(name: str) -> str:
    """Return words for the process that holds a lock, as far as the kernel knows it."""
    if sys.platform != 'linux':
        return 'a process of this machine'
    with socket.socket(socket.AF_UNIX) as asking:
        asking.setblocking(False)
        try:
            asking.connect(f'\0{name}')
        except OSError:  # it has just released the lock
            return 'a process that is ending'
        # struct ucred of socket(7): process, user, group.
        answer = asking.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize('3i'))
    process = struct.unpack('3i', answer)[0]
    folder = Path('/proc', str(process))
    try:
        words = (folder / 'cmdline').read_bytes().split(b'\0')
        state = (folder / 'stat').read_bytes().rpartition(b') ')[2][:1]
    except OSError:
        words, state = [], b''
    command = ' '.join(Path(word.decode(errors='replace')).name for word in words[:2])
    named = f'process {process} ({command})' if command else f'process {process}'
    return f'{named}, stopped as by Ctrl-Z (`fg` continues it)' if state == b'T' else named


def _has_participants(domain: int) -> bool:
    """Return whether a participant without a lock is there, by the ports that it binds."""
    first = _PORT_BASE + _DOMAIN_GAIN * domain
    for port in (first, *(first + 10 + 2 * each for each in range(_MOST_PARTICIPANTS))):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(('', port))
            except OSError:
                return True
    return False
