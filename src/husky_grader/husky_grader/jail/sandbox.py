# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a jail asks of a sandbox, and the one that separates nothing."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
import marshal
import os
from pathlib import Path
from typing import Protocol

from husky_runtime.children import ChildProcess
from husky_runtime.descendants import descendants_ended, pids_below
from husky_runtime.domains import NO_OTHER_WAY, OwnDomain
from husky_runtime.shared_memory import check_shared_memory
import psutil

from husky_grader.jail.folders import INSIDE, Mount, PYTHON
from husky_grader.jail.limits import Limits

# Where there is only the loopback interface, SUBNET is nobody else. With LOCALHOST rmw_fastrtps
# adds shared memory, by which data is lost between two that have a /dev/shm each.
OWN_NETWORK = {
    **{'ROS_DOMAIN_ID': '0', 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'SUBNET', **NO_OTHER_WAY},
    'FASTDDS_BUILTIN_TRANSPORTS': 'UDPv4',
}
# What starts a jail gets nothing of the grader's environment: a jailed program may read it.
CLEAN = {'PATH': '/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin', 'LC_ALL': 'C'}
# In a report that of the machine would be nobody's business; this one has an address everywhere.
HOST_NAME = 'localhost'
FIRST_USER = 2**30  # above it no system gives numbers to people or services
_MAX_WORD = 100_000  # bytes; Linux starts no program with one over 128 KiB, see execve(2)


class NoSandbox(ValueError):
    """There is no sandbox, or not the one asked for; the message says what to do."""


class SandboxFails(NoSandbox):
    """One sandbox does not work here; the message says why."""


@dataclass(frozen=True)
class Call:
    """A command to run in a jail."""

    command: Sequence[str]
    environment: Mapping[str, str]
    folder: Path  # where it starts
    mounts: Sequence[Mount]
    limits: Limits
    # The number of a pipe's reading end: when nobody can write to it any more, all has to end.
    lifeline: int | None = None


@dataclass(frozen=True)
class Entry:
    """How a call gets into a sandbox."""

    command: Sequence[str]
    environment: Mapping[str, str]
    # Returns the process whose end ends all that was started; None until it is there. Where there
    # is no such function, there will be no such process.
    first: Callable[[ChildProcess], psutil.Process | None] | None = None
    is_first_elsewhere: bool = False  # that process is no descendant of the command
    takes_lifeline: bool = False  # whether the command gets the lifeline of the call


def first_child(child: ChildProcess) -> psutil.Process | None:
    """Return the process that a child has started; None if there is none."""
    try:
        return next(map(psutil.Process, pids_below(child.pid)), None)
    except psutil.NoSuchProcess:
        return None


class Cell(Protocol):
    """An open sandbox."""

    @property
    def graph(self) -> Mapping[str, str]:
        """Return the variables by which nodes in it and beside it find each other."""

    @property
    def user(self) -> int | None:
        """Return the number of the user as whom commands run; None: who calls."""

    def enter(self, call: Call) -> Entry:
        """Return the command that runs another one inside."""

    def beside(self, command: Sequence[str]) -> list[str]:
        """Return the command that runs another one outside, but in the same network."""

    def ending_all(self) -> AbstractContextManager[None]:
        """End what else was started meanwhile."""


class Sandbox(Protocol):
    """A way to separate programs from the rest of the machine."""

    @property
    def name(self) -> str: ...

    @property
    def one_at_a_time(self) -> bool:
        """Tell whether two submissions must not run at once: their programs can meet."""

    def open(self) -> AbstractContextManager[Cell]:
        """
        Open a network that is the jail's own.

        :raises SandboxFails: if it does not work here.
        """


def joining(holder: int) -> list[str]:
    """Return the words before a command that joins the network of a process, and ends with us."""
    own_user = [] if os.geteuid() == 0 else ['--user', '--preserve-credentials']
    join = ['nsenter', '--target', str(holder), '--net', *own_user, '--']
    # To join a user namespace takes back what die_with_parent has asked for.
    return [*join, 'setpriv', '--pdeathsig', 'KILL', '--']


def inside(
    call: Call,
    *,
    user: int | None,
    mounts: Sequence[Mount] = (),
    readable: Sequence[str] = ('/',),
    needs_landlock: bool = False,
    counts_tasks: bool = True,
) -> list[str]:
    """
    Return the command that takes the last step into a jail; see inside.py.

    :param readable: what Landlock lets it read; where the mounts do not say it already.
    :param counts_tasks: whether the kernel counts the processes of the jail's user alone.
    """
    plan = {
        'mounts': [tuple(mount) for mount in mounts],
        'host_name': HOST_NAME,
        'readable': list(readable),
        'writable': [mount.target for mount in call.mounts if mount.kind != 'read'],
        'needs_landlock': needs_landlock,
        'limits': call.limits.for_each_process(counts_tasks=counts_tasks),
        'user': user,
        'lifeline': call.lifeline,
        'umask': _umask(),
        'folder': str(call.folder),
        'environment': dict(call.environment),
        'command': list(call.command),
    }
    # As JSON it would take longer to read than all the rest.
    told = marshal.dumps(plan).hex()
    words = (told[at : at + _MAX_WORD] for at in range(0, len(told), _MAX_WORD))
    return [str(PYTHON), '-I', '-S', str(INSIDE), *words]


def _umask() -> int:
    """Return that of this process; to ask by os.umask is to change it, for other threads too."""
    lines = Path('/proc/self/status').read_bytes().splitlines()
    found = (int(line.split()[1], 8) for line in lines if line.startswith(b'Umask:'))
    return next(found, 0o022)  # gVisor's status has none


@dataclass(frozen=True)
class MissingSandbox:
    """One that was not found, for what may be refused before it is asked for."""

    name: str
    why: str
    one_at_a_time = False

    def open(self) -> AbstractContextManager[Cell]:
        raise NoSandbox(self.why)


class Nothing:
    """No sandbox: a DDS domain of its own, and no process that outlives the jail."""

    name = 'none'
    one_at_a_time = False  # there they can do anything to each other, at any time

    @contextmanager
    def open(self) -> Iterator[Cell]:
        try:
            check_shared_memory()
        except ValueError as error:
            raise SandboxFails(str(error)) from None
        with OwnDomain() as domain, descendants_ended():
            yield _Open(domain.environment)


@dataclass(frozen=True)
class _Open:
    graph: Mapping[str, str]
    user = None

    def enter(self, call: Call) -> Entry:
        return Entry(['env', '-C', str(call.folder), *call.command], call.environment)

    def beside(self, command: Sequence[str]) -> list[str]:
        return list(command)

    def ending_all(self) -> AbstractContextManager[None]:
        return descendants_ended()
