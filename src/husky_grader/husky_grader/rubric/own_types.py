# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Types of messages and services that a rubric brings along, in packages of interfaces.

They are built once and kept in the user's cache, by what stands in them. The programs that are
graded never see them: students write packages of the same names themselves.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, ExitStack
import errno
import fcntl
from functools import lru_cache
import hashlib
import json
import os
from pathlib import Path
import shutil
import subprocess
import sys

from husky_course.files import replacing

from husky_grader.rubric.colcon_errors import first_error

Variables = Mapping[str, str]
"""What is put before the lists of folders in an environment, by the names of the variables."""

_NAMES = ('AMENT_PREFIX_PATH', 'PYTHONPATH', 'LD_LIBRARY_PATH')
_FOUND = 'variables.json'  # written last: what lies beside it is complete
_SOURCED = 'unset "${@:2}"; source "$1/local_setup.bash" >/dev/null; env -0'


def files_of(package: Path) -> list[Path]:
    """
    Return the files of a package of interfaces.

    :raises ValueError: when it is none.
    """
    if not (package / 'package.xml').is_file():
        raise ValueError(f'{package} has no package.xml; name the folder of a package')
    return sorted(path for path in package.rglob('*') if path.is_file())


def find_types(packages: Sequence[Path]) -> None:
    """
    Let this process find the types of packages, but not make publishers and services of them.

    :raises ValueError: when one cannot be built; the message says why.
    """
    entries = build_types(tuple(packages)).get('PYTHONPATH', '').split(os.pathsep)
    # First, as in `with_types`: the terminal may have a workspace with packages of these names.
    sys.path[:0] = [entry for entry in entries if entry and entry not in sys.path]


def with_types(environment: Mapping[str, str], packages: Sequence[Path]) -> dict[str, str]:
    """
    Return the environment of a program that uses the types of packages.

    :raises ValueError: when one cannot be built; the message says why.
    """
    both = dict(environment)
    for name, entries in build_types(tuple(packages)).items():
        both[name] = os.pathsep.join(filter(None, (entries, both.get(name))))
    return both


@lru_cache
def build_types(packages: tuple[Path, ...]) -> Variables:
    """
    Build packages, unless that was done before, and return what leads to their types.

    :raises ValueError: when one cannot be built; the message says why.
    """
    if not packages:
        return {}
    with _kept_folder(_digest(packages)) as folder:
        found = folder / _FOUND
        if not found.is_file():
            _build(packages, folder)
            told = json.dumps(_sourced(folder / 'install'))
            with replacing(found) as part:
                part.write_text(told, encoding='utf-8')
        variables: Variables = json.loads(found.read_text(encoding='utf-8'))
        return variables


def _digest(packages: Sequence[Path]) -> str:
    digest = hashlib.sha256(f'{sys.version} {sys.prefix} {os.environ.get("PATH")}'.encode())
    for package in packages:
        for path in files_of(package):
            digest.update(f'{package.name}/{path.relative_to(package)}\n'.encode())
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()[:32]


@contextmanager
def _kept_folder(name: str) -> Iterator[Path]:
    """Open a folder of the user's cache for this process alone."""
    cache = Path(os.environ.get('XDG_CACHE_HOME', ''))
    if not cache.is_absolute():
        cache = Path(os.path.expanduser('~'), '.cache')  # noqa: PTH111  # the other raises
    folder = cache / 'husky_playpen_lab' / 'interfaces' / name
    with ExitStack() as stack:
        try:
            if not cache.is_absolute():
                raise FileNotFoundError(errno.ENOENT, 'this user has no home')
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            lock = stack.enter_context(folder.with_suffix('.lock').open('w'))
            fcntl.flock(lock, fcntl.LOCK_EX)  # a home on a network may have no locks
        except OSError as error:
            raise ValueError(
                f'interfaces cannot be built in {folder}: {error.strerror}; '
                'let XDG_CACHE_HOME name a folder that can be written, on a disk of this computer'
            ) from None
        yield folder


def _build(packages: Sequence[Path], folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)  # of a build that was killed
    folder.mkdir(mode=0o700)
    command = ['colcon', '--log-base', str(folder / 'log'), 'build', '--merge-install']
    command += ['--build-base', str(folder / 'build')]
    command += ['--install-base', str(folder / 'install')]
    command += ['--paths', *map(str, packages)]
    try:
        built = subprocess.run(
            command, capture_output=True, cwd=folder, text=True, errors='replace'
        )
    except FileNotFoundError:
        raise ValueError('colcon, which builds them, is not installed here') from None
    if built.returncode != 0:
        raise ValueError(first_error(built.stderr) or 'colcon build fails')


def _sourced(install: Path) -> Variables:
    """Return what sourcing a prefix puts into variables that are empty before."""
    command = ['bash', '-c', _SOURCED, 'bash', str(install), *_NAMES]
    told = subprocess.run(command, capture_output=True, text=True).stdout
    pairs = dict(entry.split('=', 1) for entry in told.split('\0') if '=' in entry)
    if not pairs.get('PYTHONPATH'):
        raise ValueError(f'{install}: nothing was built that Python can read')
    return {name: pairs[name] for name in _NAMES if pairs.get(name)}
