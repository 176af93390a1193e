# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Find a sandbox that works on this machine."""

from collections.abc import Sequence
from pathlib import Path
import subprocess
from tempfile import TemporaryDirectory

from husky_grader.jail.containers import DOCKER, PODMAN
from husky_grader.jail.jail import Jail
from husky_grader.jail.namespaces import BWRAP, KERNEL
from husky_grader.jail.sandbox import NoSandbox, Nothing, Sandbox, SandboxFails
from husky_grader.jail.user import USER

_NONE = Nothing()
_SEPARATING: tuple[Sandbox, ...] = (BWRAP, PODMAN, DOCKER, KERNEL, USER)
SANDBOXES = (*(sandbox.name for sandbox in _SEPARATING), _NONE.name)
_TRIED_WITHIN_SEC = 30.0
_RESTRICTED = Path('/proc/sys/kernel/apparmor_restrict_unprivileged_userns')


def find_sandbox(wanted: str = 'auto') -> Sandbox:
    """
    Return the first sandbox in which a program runs here, or the one that is wanted.

    :param wanted: one of SANDBOXES; auto is none that separates nothing.
    :raises NoSandbox: if none works, or not the wanted one.
    """
    if wanted == _NONE.name:
        return _NONE
    tried = [sandbox for sandbox in _SEPARATING if wanted in ('auto', sandbox.name)]
    if not tried:
        raise NoSandbox(f'sandbox {wanted!r}: allowed are auto, {", ".join(SANDBOXES)}')
    failures = []
    for sandbox in tried:
        try:
            _try(sandbox)
        except SandboxFails as failure:
            failures.append(f'{sandbox.name}: {failure}')
        else:
            return sandbox
    if wanted != 'auto':  # another may
        raise NoSandbox(
            f'sandbox {"; ".join(failures)}; without --sandbox the first that works here is taken'
        )
    raise NoSandbox(f'no sandbox works here ({"; ".join(failures)}); {_advice()}')


def _try(sandbox: Sandbox) -> None:
    with TemporaryDirectory(prefix='jail-') as name:
        Path(name).chmod(0o711)
        folder, log = Path(name, 'folder'), Path(name, 'log')
        folder.mkdir()
        with Jail(sandbox, folder) as jail:
            exit_code = jail.run(['true'], log=log, within_sec=_TRIED_WITHIN_SEC)
            beside = _run(jail.beside(['true']))
        if beside.returncode != 0:
            raise SandboxFails(beside.stderr.strip().replace('\n', ' '))
        if exit_code != 0:
            said = log.read_text(encoding='utf-8', errors='replace').strip().splitlines()
            raise SandboxFails(said[-1] if said else f'exit code {exit_code}')


def _run(command: Sequence[str]) -> 'subprocess.CompletedProcess[str]':
    try:
        return subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise SandboxFails(f'{command[0]}: {error.strerror}') from None


def _advice() -> str:
    install = (
        'install bubblewrap 0.8 or newer, or podman (Ubuntu, Debian: sudo apt install podman)'
    )
    if _RESTRICTED.is_file() and _RESTRICTED.read_text().strip() != '0':
        # Ubuntu 24.04 lets podman make namespaces, and bubblewrap not.
        install = (
            'install podman (sudo apt install podman), or allow namespaces to all programs: '
            f'echo 0 | sudo tee {_RESTRICTED}'
        )
    return f'{install}; --sandbox none runs what was handed in with all your rights'
