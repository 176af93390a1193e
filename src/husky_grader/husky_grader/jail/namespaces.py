# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Sandboxes made of the kernel's namespaces, by bubblewrap or by util-linux and Landlock.

A process holds the network, and each command enters it with files and processes of its own. An
ordinary user gets the right to all this in a user namespace. Root has it anyway, so its commands
run as a user that nobody is.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
import os
from pathlib import Path
import shutil
import subprocess

from husky_runtime.children import ChildProcess
import psutil

from husky_grader.jail.folders import PYTHON
from husky_grader.jail.sandbox import Call, Cell, CLEAN, inside, OWN_NETWORK, SandboxFails

_LOOPBACK = Path(__file__).with_name('loopback.py').resolve()
_FIRST_USER = 2**30  # above it no system gives numbers to people or services
_BWRAP_KINDS = {'read': '--ro-bind', 'write': '--bind'}


@dataclass(frozen=True)
class _Cell:
    """The namespaces that a process holds."""

    holder: int  # its number
    graph = OWN_NETWORK
    is_root: bool = field(default_factory=lambda: os.geteuid() == 0)

    @property
    def user(self) -> int | None:
        return _FIRST_USER + self.holder if self.is_root else None

    def _join(self) -> list[str]:
        own_user = [] if self.is_root else ['--user', '--preserve-credentials']
        return ['nsenter', '--target', str(self.holder), '--net', *own_user, '--']

    def beside(self, command: Sequence[str]) -> list[str]:
        # To join a user namespace takes back what die_with_parent has asked for.
        return [*self._join(), 'setpriv', '--pdeathsig', 'KILL', '--', *command]

    def first_of(self, child: ChildProcess) -> psutil.Process | None:
        try:
            return next(iter(psutil.Process(child.pid).children()), None)
        except psutil.NoSuchProcess:
            return None

    def ending_all(self) -> AbstractContextManager[None]:
        return nullcontext()  # they have ended with their process namespace


class _Bwrap(_Cell):
    def enter(self, call: Call) -> tuple[list[str], Mapping[str, str]]:
        own_user = [] if self.is_root else ['--unshare-user', '--disable-userns']
        words = ['bwrap', '--die-with-parent', '--unshare-pid', '--unshare-ipc', *own_user]
        words += ['--proc', '/proc', '--dev', '/dev']
        for kind, source, target in call.mounts:
            if kind == 'memory':
                words += ['--perms', '1777', '--size', source, '--tmpfs', target]
            else:
                # By itself it makes the folders above so that only root can pass.
                words += ['--dir', str(Path(target).parent), _BWRAP_KINDS[kind], source, target]
        words += ['--remount-ro', '/', '--', *inside(call, user=self.user)]
        return [*self._join(), *words], CLEAN


class _Kernel(_Cell):
    def enter(self, call: Call) -> tuple[list[str], Mapping[str, str]]:
        words = ['unshare', '--pid', '--ipc', '--mount', *_own_user(self.is_root)]
        last = inside(call, user=self.user, mounts=call.mounts, needs_landlock=True)
        return [*self._join(), *words, '--', *last], CLEAN


def _own_user(is_root: bool) -> list[str]:
    return [] if is_root else ['--map-current-user', '--keep-caps']


@dataclass(frozen=True)
class _Namespaces:
    name: str
    programs: tuple[str, ...]
    cell: type[_Bwrap | _Kernel]

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
        [*words, str(PYTHON), '-I', '-S', str(_LOOPBACK)],
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
