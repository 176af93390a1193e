# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A sandbox for root where there are no namespaces, as in many containers: another user.

Commands run as a user that nobody is, so that they can neither signal, trace nor read what
belongs to others. Landlock, where the kernel has it, narrows what they read and write to what
other sandboxes show. The network and the list of processes are the machine's; nodes keep to the
loopback interface and a DDS domain of their own. All commands of a jail are one user, so that the
end of one ends the others too, and removes what that user has in the kernel's System V IPC.
"""

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from dataclasses import dataclass, replace
from itertools import count
import os
from pathlib import Path
import shutil
import stat
import sys

from husky_runtime.domains import NO_OTHER_WAY, OwnDomain

from husky_grader.jail.folders import home_of, PYTHON
from husky_grader.jail.sandbox import (
    Call,
    Cell,
    CLEAN,
    Entry,
    first_child,
    FIRST_USER,
    inside,
    SandboxFails,
)

_GUARD = Path(__file__).with_name('guard.py').resolve()
_PROFILE = Path(__file__).with_name('loopback.xml').resolve()
_SHARED = ('/tmp', '/dev/shm')
_DOMAINS = 128  # more than there are; below it a user's number tells the domain
_MOST_USERS = 8000  # of a domain: guard.py takes the numbers above them for itself
_ALWAYS_READ = ('/proc', '/dev')


_opened = count()  # jails of this process


@dataclass(frozen=True)
class _Cell:
    """A DDS domain, and a user."""

    domain: int
    user: int

    @property
    def graph(self) -> dict[str, str]:
        return {
            'ROS_DOMAIN_ID': str(self.domain),
            # Left alone by ROS, Fast DDS does what the profile says. With LOCALHOST it would add
            # shared memory, which two users do not share, and all data would be lost.
            'ROS_AUTOMATIC_DISCOVERY_RANGE': 'SYSTEM_DEFAULT',
            **NO_OTHER_WAY,
            'FASTRTPS_DEFAULT_PROFILES_FILE': str(_PROFILE),
        }

    def enter(self, call: Call) -> Entry:
        _check_ways(call.folder)
        readable = [mount.target for mount in call.mounts if mount.kind == 'read']
        # In /tmp lies what belongs to others, and Landlock lets read what it lets write.
        own = replace(
            call,
            mounts=[mount for mount in call.mounts if mount.target != '/tmp'],
            environment={**call.environment, 'TMPDIR': str(home_of(call.folder))},
        )
        last = inside(own, user=self.user, readable=[*readable, *_ALWAYS_READ])
        # From Python 3.12 on os.fork warns where there is a thread, into the command's output.
        words = [str(PYTHON), '-I', '-S', '-W', 'ignore', str(_GUARD)]
        words += [str(self.user), str(call.lifeline), *last]
        return Entry(words, CLEAN, first_child, takes_lifeline=True)

    def beside(self, command: Sequence[str]) -> list[str]:
        return list(command)

    def ending_all(self) -> AbstractContextManager[None]:
        return nullcontext()  # the guard has ended them

    def remove_shared_files(self) -> None:
        """Remove what the user has left where everybody may write."""
        for path in (path for folder in _SHARED for path in Path(folder).iterdir()):
            with suppress(FileNotFoundError):  # removed meanwhile
                if path.lstat().st_uid != self.user:
                    continue
                if path.is_dir() and not path.is_symlink():
                    shutil.rmtree(path, ignore_errors=True)
                else:
                    path.unlink()


class _User:
    name = 'user'
    one_at_a_time = True  # a program may enter any DDS domain of the machine

    @contextmanager
    def open(self) -> Iterator[Cell]:
        if os.geteuid() != 0:
            raise SandboxFails('only root can run programs as somebody else')
        _check_ways(Path(sys.prefix), PYTHON, _GUARD)
        with OwnDomain() as domain:
            # Nobody who has been before: what was built belongs to the user of another jail.
            user = FIRST_USER + _DOMAINS * (next(_opened) % _MOST_USERS) + domain.number
            cell = _Cell(domain.number, user)
            try:
                yield cell
            finally:
                cell.remove_shared_files()


USER = _User()


def _check_ways(*places: Path) -> None:
    """
    Check that another user can pass to some places.

    :raises SandboxFails: naming the folder that bars the way.
    """
    for place in places:
        for folder in place.parents:
            if not folder.stat().st_mode & stat.S_IXOTH:
                raise SandboxFails(
                    f'{place}: only its owner can pass {folder}; put it elsewhere, or allow it '
                    f'to all: chmod o+x {folder}'
                )
