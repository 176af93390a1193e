# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A bare git repository as the tar of its last commit; no hook or setting of it is obeyed."""

from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import subprocess
from tempfile import TemporaryDirectory
from threading import Timer
from typing import cast, IO

from husky_grader.submission.entries import CHUNK_BYTES
from husky_grader.submission.limits import Meter, Refused

_GIT_WITHIN_SEC = 60.0  # wall time of each call

# What it says where somebody else owns a repository, from 2.35.2 and from 2.36 on.
_OF_ANOTHER = ('unsafe repository', 'dubious ownership')


def is_bare(folder: Path) -> bool:
    """Tell whether a folder is a bare repository."""
    return (folder / 'HEAD').is_file() and all(
        (folder / name).is_dir() for name in ('objects', 'refs')
    )


@contextmanager
def tar_of(repository: Path, meter: Meter) -> Iterator[IO[bytes]]:
    """
    Give the tar of the commit that HEAD names.

    Git runs in a clone, which has neither settings nor hooks of the repository: see
    `git clone --no-local` in gitsecurityboundary(7), and SECURITY in git(1).

    :param meter: counts the files; a commit can name a million times as many as it holds.
    :raises Refused: when git cannot read it or takes too long, or it has too many files.
    """
    with TemporaryDirectory() as folder:
        clone = str(Path(folder, 'clone'))
        place = str(repository.absolute())
        _run('clone', '--quiet', '--bare', '--no-local', '--depth=1', '--', place, clone)
        _run('-C', clone, 'rev-parse', '--quiet', '--verify', 'HEAD^{commit}')
        with _output('-C', clone, 'ls-tree', '-r', '-t', '-z', '--name-only', 'HEAD') as names:
            while chunk := names.read(CHUNK_BYTES):
                for _ in range(chunk.count(b'\0')):
                    meter.add_entry()
        with _output('-C', clone, 'archive', '--format=tar', 'HEAD') as tar:
            yield tar


@contextmanager
def _output(*arguments: str) -> Iterator[IO[bytes]]:
    """Give what git prints; it ends with what is not read of it, or after a while."""
    with subprocess.Popen(
        ['git', *arguments],
        env=_environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    ) as git:
        watch = Timer(_GIT_WITHIN_SEC, git.kill)
        watch.start()
        try:
            yield cast(IO[bytes], git.stdout)
        finally:
            watch.cancel()
            git.kill()


def _run(*arguments: str) -> None:
    try:
        done = subprocess.run(
            ['git', *arguments],
            env=_environment(),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors='replace',
            timeout=_GIT_WITHIN_SEC,
        )
    except FileNotFoundError:
        raise Refused('a bare repository, and git is not installed here; install git') from None
    except subprocess.TimeoutExpired:
        raise Refused(f'git takes more than {_GIT_WITHIN_SEC:g} s; hand in a zip') from None
    if done.returncode != 0:
        raise Refused(why_not(done.stderr))


def why_not(said: str) -> str:
    """Return in one line why git cannot read a repository, from what it says of that."""
    if any(words in said for words in _OF_ANOTHER):
        return (
            'a bare repository of another user, which git does not read; copy it (cp -r), and '
            'give the copy'
        )
    lines = said.strip().splitlines() or ['there is no commit']
    return f'git cannot read it ({lines[-1]}); push a commit, or hand in a zip'


def _environment() -> dict[str, str]:
    """Return an environment in which git takes no other repository, and asks nobody."""
    plain = {name: value for name, value in os.environ.items() if not name.startswith('GIT_')}
    return {**plain, 'GIT_TERMINAL_PROMPT': '0', 'GIT_NO_LAZY_FETCH': '1', 'LC_ALL': 'C'}
