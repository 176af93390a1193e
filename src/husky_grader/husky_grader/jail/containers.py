# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Sandboxes made by podman or docker: each command runs in a container of its own.

Their image is empty; what is in a container is bound from the host, as in every other jail. One
more container holds the network. Containers are no children of who starts them: a shell that
waits for the end of this process removes them.
"""

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field, replace
import os
import shutil
import subprocess
from uuid import uuid4

from husky_runtime.children import ChildProcess
import psutil

from husky_grader.jail.folders import LOOPBACK, Mount, PYTHON, read_mounts
from husky_grader.jail.limits import Limits
from husky_grader.jail.sandbox import (
    Call,
    Cell,
    Entry,
    FIRST_USER,
    inside,
    joining,
    OWN_NETWORK,
    SandboxFails,
)

_IMAGE = 'localhost/husky_playpen_lab:empty'
_EMPTY_ARCHIVE = bytes(10240)  # tar(5): two records of zeros, filled up to a block
_LABEL = 'husky_playpen_lab'
# Both give the proxies of who calls, which may be with a password, to every container.
_PROXIES = ('http_proxy', 'https_proxy', 'ftp_proxy', 'no_proxy', 'all_proxy')
_ASKED_WITHIN_SEC = 60.0


@dataclass(frozen=True)
class _Cell:
    """The containers of a jail."""

    program: str
    name: str  # of the one that holds the network, and the label of all
    holder: int  # the number of its process
    user: int | None = field(
        default_factory=lambda: FIRST_USER + os.getpid() if os.geteuid() == 0 else None
    )
    graph = OWN_NETWORK

    def enter(self, call: Call) -> Entry:
        name = f'{self.name}-{uuid4().hex}'
        words = [*_run(self.program, self.name, call.limits), '--name', name, '--interactive']
        same, user = f'container:{self.name}', self.user
        owner = f'{os.getuid()}:{os.getgid()}' if user is None else f'{user}:{user}'
        words += ['--network', same, *_in_users(self.program, same), '--user', owner]
        words += [*_volumes(call.mounts), _IMAGE]
        # Who else runs with the same number counts too, where there is no namespace of users.
        # Nor does an open file get into it: what removes it ends with the grader.
        last = inside(replace(call, lifeline=None), user=None, counts_tasks=False)
        first = _First(self.program, name)
        return Entry([*words, *last], os.environ, first, is_first_elsewhere=True)

    def beside(self, command: Sequence[str]) -> list[str]:
        return [*joining(self.holder), *command]

    def ending_all(self) -> AbstractContextManager[None]:
        return nullcontext()  # they have ended with their container


class _First:
    """Finds the first process of a container, and asks no more when it is found."""

    def __init__(self, program: str, container: str) -> None:
        self._program, self._container = program, container
        self._found: psutil.Process | None = None

    def __call__(self, child: ChildProcess) -> psutil.Process | None:
        if self._found is None and child.exit_code is None:
            self._found = _process_of(self._program, self._container)
        return self._found


@dataclass(frozen=True)
class _Containers:
    name: str
    one_at_a_time = False

    @contextmanager
    def open(self) -> Iterator[Cell]:
        if shutil.which(self.name) is None:
            raise SandboxFails(f'{self.name} not installed')
        _make_image(self.name)
        jail = f'{_LABEL}-{uuid4().hex}'
        with _removing(self.name, jail):
            words = [*_run(self.name, jail, Limits()), '--name', jail, '--network', 'none']
            words += [*_in_users(self.name, 'keep-id'), '--user', '0:0', '--cap-add', 'NET_ADMIN']
            words += [*_volumes(read_mounts(())), _IMAGE]
            with subprocess.Popen(
                [*words, str(PYTHON), '-I', '-S', str(LOOPBACK)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                text=True,
            ) as client:
                assert client.stdout is not None
                try:
                    said = ''
                    for line in client.stdout:  # after warnings, if there are any
                        if (said := line.strip()) == 'ready':
                            break
                    holder = _process_of(self.name, jail) if said == 'ready' else None
                    if holder is None:
                        raise SandboxFails(said)
                    yield _Cell(self.name, jail, holder.pid)
                finally:
                    client.kill()


PODMAN, DOCKER = _Containers('podman'), _Containers('docker')


def _run(program: str, jail: str, limits: Limits) -> list[str]:
    """Return the command that runs a container which may do nothing."""
    words = [program, 'run', '--rm', '--label', f'{_LABEL}={jail}', '--read-only']
    words += ['--log-driver', 'none']  # they would keep all that is printed
    words += ['--cap-drop', 'ALL', '--security-opt', 'no-new-privileges']
    words += ['--security-opt', 'label=disable']
    words += ['--ulimit', f'nofile={limits.open_files}']
    # Where a container has users of its own, the kernel counts their processes by itself.
    counted = ('--ulimit', f'nproc={limits.tasks}'), ('--pids-limit', str(limits.tasks))
    words += counted[0] if program == 'podman' else counted[1]
    for proxy in _PROXIES:
        words += ['--env', f'{proxy}=', '--env', f'{proxy.upper()}=']
    return words


def _in_users(program: str, namespace: str) -> list[str]:
    """Return the words for a namespace of users, which only podman has, for those without root."""
    return ['--userns', namespace] if program == 'podman' and os.geteuid() != 0 else []


def _volumes(mounts: Sequence[Mount]) -> list[str]:
    words = []
    for kind, source, target in mounts:
        if target == '/dev/shm':
            words += ['--shm-size', source]
        elif kind == 'memory':
            words += ['--tmpfs', f'{target}:rw,nosuid,nodev,exec,size={source},mode=1777']
        else:
            words += ['--volume', f'{source}:{target}:{"ro" if kind == "read" else "rw"}']
    return words


def _make_image(program: str) -> None:
    if _asked(program, 'image', 'inspect', _IMAGE).returncode != 0:
        made = _asked(program, 'import', '-', _IMAGE, given=_EMPTY_ARCHIVE)
        if made.returncode != 0:
            said = made.stderr.decode(errors='replace').strip().splitlines()
            raise SandboxFails(said[-1] if said else f'{program} import failed')


def _process_of(program: str, container: str) -> psutil.Process | None:
    """Return the first process of a container; None if it does not run."""
    try:
        said = _asked(program, 'inspect', '--format', '{{.State.Pid}}', container)
        number = int(said.stdout)
        return psutil.Process(number) if number else None
    except (SandboxFails, ValueError, psutil.NoSuchProcess):
        return None


def _asked(
    program: str, *words: str, given: bytes | None = None
) -> subprocess.CompletedProcess[bytes]:
    try:
        return subprocess.run(
            [program, *words], input=given, capture_output=True, timeout=_ASKED_WITHIN_SEC
        )
    except subprocess.TimeoutExpired:
        raise SandboxFails(f'{program} {words[0]}: no answer') from None


@contextmanager
def _removing(program: str, jail: str) -> Iterator[None]:
    """Remove all containers of a jail at last, also when this process is killed."""
    find = f'{program} ps --all --quiet --filter label={_LABEL}={jail}'
    # rm alone would give each ten seconds to end.
    script = f'cat; {find} | xargs -r {program} kill; {find} | xargs -r {program} rm --force'
    with subprocess.Popen(
        ['sh', '-c', script],
        stdin=subprocess.PIPE,  # closed by the kernel, at the latest
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    ):
        yield
