# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Build a workspace, and find what was built."""

from collections.abc import Callable, Mapping
import os
from pathlib import Path
from tempfile import TemporaryDirectory
import time

from husky_grader.jail import Jail, JailedProcess
from husky_grader.lab.file_steps import find_manifests, no_packages
from husky_grader.lab.finding import Finding, nothing
from husky_grader.lab.programs import is_there
from husky_grader.rubric.colcon_errors import (
    failed_packages,
    first_error,
    is_without_setup,
    missing_setup,
    printing_setup,
    setuptools_error,
    without_own_errors,
)
from husky_grader.run.diagnosis import crash, how_ended

BUILD_WITHIN_SEC = 300.0
ALIVE_EVERY_SEC = 1.0  # how often `alive` is called during a build
SOURCE_WITHIN_SEC = 60.0
NO_PROGRAM = 127  # as a shell says it
MAX_VARIABLES = 30_000  # bytes, of all of them together; Linux starts no program with too many
# The wheels' colcon refuses packages that another one builds: points are the same with both.
_AS_ANYWHERE = {'COLCON_EXTENSION_BLOCKLIST': 'colcon_core.package_identification.refused'}
# The wheels bring ros2_diagnosis, a sourced ROS does not.
_SAYS_WHY = """
from importlib.util import find_spec
from pathlib import Path
import sys
if find_spec('ros2_diagnosis'):
    from ros2_diagnosis.package_files import why_refused
    print(*why_refused(Path(sys.argv[1])), sep='\\n')
"""
NEVER_CALLED = 'setup.py does not call setup()'
_BEGUN = 'Starting >>>'  # is printed before anything of a student's runs
_OF_THE_SHELL = ('HOME', 'PWD', 'OLDPWD', 'SHLVL', '_')  # each program has its own


class ColconMissing(ValueError):
    """There is no colcon in the jail; the message says what to do."""


def build_step(
    workspace: Path, jail: Jail, log: Path, *, alive: Callable[[], object] = lambda: None
) -> Finding:
    """
    Build the workspace with colcon, into the jail's folder, so that nothing of it changes.

    :param alive: called now and then.
    :raises ColconMissing: when it cannot be started, which is not the student's fault.
    """
    if not find_manifests(workspace):
        instead = no_packages(workspace) or ['ros2 pkg create makes one']
        return nothing('; '.join(['there is no package in src', *instead]))
    command = ['colcon', '--log-base', str(jail.folder / 'log'), 'build', '--continue-on-error']
    command += ['--base-paths', str(workspace / 'src')]
    command += ['--build-base', str(jail.folder / 'build')]
    command += ['--install-base', str(jail.folder / 'install')]
    with jail.started(command, _AS_ANYWHERE, log=log) as build:
        exit_code = build.exit_code if _has_ended(build, alive) else None
    if build.stopped:
        return nothing(f'colcon build was ended: it {build.stopped}')
    if exit_code is None:
        return nothing(f'colcon build took longer than {BUILD_WITHIN_SEC:g} s')
    if exit_code != 0:
        text = log.read_text(encoding='utf-8', errors='replace')
        if exit_code == NO_PROGRAM and _BEGUN not in text:
            raise ColconMissing(
                'colcon cannot be started; install it, or if it is there let every user read it '
                f'({text.strip()})'
            )
        how = how_ended(exit_code) if exit_code < 0 else f'see {log.name}'
        told = without_own_errors(text).replace(f'{log.parent}/', '')  # before it is shortened
        spoilt = printing_setup(told) or missing_setup(told)
        spoilt = spoilt or _why_refused(told, workspace, jail)
        why = spoilt or crash(told) or first_error(told) or how
        return nothing(f'colcon build failed: {why}')
    if not _has_built(jail.folder / 'install'):
        return nothing(
            'colcon build has built no package: it passed over all of them, as for what is wrong '
            f'in a colcon.pkg; see {log.name}'
        )
    return Finding('colcon build succeeded')


def _has_built(install: Path) -> bool:
    """Tell whether there is a folder of a package; where there is none, colcon succeeds, too."""
    return is_there(install) and any(map(os.path.isdir, install.iterdir()))


def _why_refused(printed: str, workspace: Path, jail: Jail) -> str:
    """
    Return what is wrong in the files of a package that failed; empty if that is not known.

    The wheels' colcon would have said it; setuptools does, when colcon does not come between.
    Each setup.py may wait for ever, so that all of them together have SOURCE_WITHIN_SEC.
    """
    failed = failed_packages(printed)
    deadline_sec = time.monotonic() + SOURCE_WITHIN_SEC
    for manifest in find_manifests(workspace):
        if manifest.name not in failed:
            continue
        command = ['python3', '-c', _SAYS_WHY, str(manifest.folder)]
        if known := _said(jail, command, deadline_sec).strip():
            return f'{manifest.name}: {known.splitlines()[0]}'
        if is_without_setup(printed):
            command = ['bash', '-c', 'cd "$0" && python3 setup.py --version', str(manifest.folder)]
            said = _said(jail, command, deadline_sec)
            if why := setuptools_error(said) or ('' if said.strip() else NEVER_CALLED):
                return f'{manifest.name}: {why}'
        if time.monotonic() > deadline_sec:
            break
    return ''


def _said(jail: Jail, command: list[str], deadline_sec: float) -> str:
    with TemporaryDirectory() as place:
        log = Path(place) / 'said'
        jail.run(command, log=log, within_sec=max(deadline_sec - time.monotonic(), 0.0))
        return log.read_text(encoding='utf-8', errors='replace')


def _has_ended(build: JailedProcess, alive: Callable[[], object]) -> bool:
    """Wait for the end of a build; tell whether it came in time."""
    deadline_sec = time.monotonic() + BUILD_WITHIN_SEC
    while not build.wait(ALIVE_EVERY_SEC):
        alive()
        if time.monotonic() > deadline_sec:
            return False
    return True


def sourced(jail: Jail) -> Mapping[str, str]:
    """
    Return the environment after sourcing what was built, and let everybody read that.

    :raises ValueError: when nothing was built, or sourcing fails, takes too long or sets too much.
    """
    if not is_there(jail.folder / 'install' / 'local_setup.bash'):
        raise ValueError('nothing was built')
    # What is built may change where programs are found.
    script = 'chmod -R a+rX "$0"; source "$0/install/local_setup.bash" >/dev/null 2>&1; "$1" -0'
    command = ['bash', '-c', script, str(jail.folder), '/usr/bin/env']
    with TemporaryDirectory() as place:  # not in a report: it has the grader's own variables, too
        log = Path(place) / 'environment'
        exit_code = jail.run(command, log=log, within_sec=SOURCE_WITHIN_SEC)
        told = os.fsdecode(log.read_bytes())
    if exit_code is None:
        raise ValueError(
            f'sourcing install/local_setup.bash took longer than {SOURCE_WITHIN_SEC:g} s; '
            'a hook of a package waits for something: take it out'
        )
    pairs = [entry.partition('=') for entry in told.split('\0') if entry]
    if exit_code != 0 or not pairs:
        raise ValueError(
            f'sourcing install/local_setup.bash ended the shell (exit code {exit_code}); '
            'a hook of a package must not call exit'
        )
    size = len(os.fsencode(told))
    if size > MAX_VARIABLES:
        raise ValueError(
            f'sourcing install/local_setup.bash sets {size} bytes of variables, {MAX_VARIABLES} '
            'are allowed; a hook of a package must set less'
        )
    return {name: value for name, _, value in pairs if name and name not in _OF_THE_SHELL}
