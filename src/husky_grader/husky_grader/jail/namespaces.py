# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Sandboxes made of the kernel's namespaces, by bubblewrap or by util-linux and Landlock.

A process holds the network, and each command enters it with files and processes of its own. An
ordinary user gets the right to all this in a user namespace. Root has it anyway, so its commands
run as a user that nobody is.
"""

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
import os
from pathlib import Path
import shutil
import subprocess

from husky_grader.jail.folders import LOOPBACK, PYTHON
from husky_grader.jail.sandbox import (
    Call,
    Cell,
    CLEAN,
    Entry,
    first_child,
    FIRST_USER,
    HOST_NAME,
    inside,
    joining,
    OWN_NETWORK,
    SandboxFails,
)

_BWRAP_KINDS = {'read': '--ro-bind', 'write': '--bind'}


@dataclass(frozen=True)
class _Cell:
    """The namespaces that a process holds."""

    holder: int  # its number
    graph = OWN_NETWORK
    is_root: bool = field(default_factory=lambda: os.geteuid() == 0)

    @property
    def user(self) -> int | None:
        return FIRST_USER + self.holder if self.is_root else None

    def beside(self, command: Sequence[str]) -> list[str]:
        return [*joining(self.holder), *command]

    def ending_all(self) -> AbstractContextManager[None]:
        return nullcontext()  # they have ended with their process namespace


class _Bwrap(_Cell):
    def enter(self, call: Call) -> Entry:
        own_user = [] if self.is_root else ['--unshare-user', '--disable-userns']
        words = ['bwrap', '--die-with-parent', '--unshare-pid', '--unshare-ipc', *own_user]
        words += ['--unshare-uts', '--hostname', HOST_NAME]
        # inside.py is the init: an init of bwrap's may end after bwrap, and with it the others.
        words += ['--as-pid-1']
        words += ['--proc', '/proc', '--dev', '/dev']
        for kind, source, target in call.mounts:
            if kind == 'memory':
                words += ['--perms', '1777', '--size', source, '--tmpfs', target]
            else:
                # By itself it makes the folders above so that only root can pass.
                words += ['--dir', str(Path(target).parent), _BWRAP_KINDS[kind], source, target]
        last = inside(call, user=self.user)
        words += ['--remount-ro', '/', '--', *last]
        enter = [*joining(self.holder), *words]
        return Entry(enter, CLEAN, first_child, takes_lifeline=True)


class _Kernel(_Cell):
    def enter(self, call: Call) -> Entry:
        words = ['unshare', '--pid', '--ipc', '--uts', '--mount', *_own_user(self.is_root)]
        last = inside(call, user=self.user, mounts=call.mounts, needs_landlock=True)
        enter = [*joining(self.holder), *words, '--', *last]
        return Entry(enter, CLEAN, first_child, takes_lifeline=True)


def _own_user(is_root: bool) -> list[str]:
    return [] if is_root else ['--map-current-user', '--keep-caps']


@dataclass(frozen=True)
class _Namespaces:
    name: str
    programs: tuple[str, ...]
    cell: type[_Bwrap | _Kernel]
    one_at_a_time = False

    @contextmanager
    def open(self) -> Iterator[Cell]:
        missing = [program for program in self.programs if shutil.which(program) is None]
        if missing:
            raise SandboxFails(f'{" and ".join(missing)} not installed')
        with _network() as holder:
            yield self.cell(holder)


BWRAP = _Namespaces('bwrap', ('unshare', 'nsenter', 'setpriv', 'bwrap'), _Bwrap)
KERNEL = _Namespaces('kernel', ('unshare', 'nsenter', 'setpriv'), _Kernel)


@contextmanager
def _network() -> Iterator[int]:
    """Start a process that holds a new network, until this one ends or is done with it."""
    words = ['unshare', '--net', *_own_user(os.geteuid() == 0), '--']
    with subprocess.Popen(
        [*words, str(PYTHON), '-I', '-S', str(LOOPBACK)],
        env=CLEAN,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
        text=True,
    ) as holder:
        assert holder.stdout is not None
        try:
            said = holder.stdout.readline().strip()
            if said != 'ready':
                raise SandboxFails(said)
            yield holder.pid
        finally:
            holder.kill()
