# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Reports of earlier calls, so that no file is graded twice.

A report is taken only with a seal that needs the grader's secret: an HMAC (RFC 2104) over all
that the grade depends on and the report itself. The secret is a file that only the user can read;
where it cannot be kept, everything is graded again.
"""

from functools import lru_cache
import hashlib
import hmac
import json
import os
from pathlib import Path
import secrets
import stat
from typing import Any

import husky_course
import husky_driver
import husky_grader
from husky_grader.report.files import is_report
import husky_sim

SEAL_FILE = '.graded'
SECRET_BYTES = 32
PROGRAM_ENDINGS = ('.py', '.css', '.jinja')
MOST_BYTES = 64_000_000  # of a report, whose run may have been a day long


class Cache:
    """Seals reports, and loads those whose seal is right."""

    def __init__(self) -> None:
        self._secret = _secret()

    def load(self, folder: Path, key: str) -> dict[str, Any] | None:
        """Return the report in a folder if it was sealed with this key."""
        try:
            text = _content(folder / 'report.json')
            seal = _content(folder / SEAL_FILE).decode('ascii')
            if self._secret is None or not hmac.compare_digest(seal, self._seal(key, text)):
                return None
            report = json.loads(text)
        except (OSError, ValueError, TypeError, RecursionError):
            return None
        return report if is_report(report) else None

    def seal(self, folder: Path, key: str) -> None:
        """
        Seal the report in a folder.

        :raises OSError: when it cannot be written.
        """
        if self._secret is not None:
            text = (folder / 'report.json').read_bytes()
            (folder / SEAL_FILE).write_text(self._seal(key, text), encoding='ascii')

    def _seal(self, key: str, text: bytes) -> str:
        secret = self._secret or b''
        return hmac.new(secret, key.encode() + b'\n' + text, 'sha256').hexdigest()


def _content(file: Path) -> bytes:
    """
    Return the content of a regular file: a pipe or a device may never end.

    :raises OSError: if it is none, or larger than any of ours.
    """
    flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK
    with os.fdopen(os.open(file, flags), 'rb') as stream:
        about = os.fstat(stream.fileno())
        if not stat.S_ISREG(about.st_mode) or about.st_size > MOST_BYTES:
            raise OSError(f'{file} is no file of ours')
        return stream.read(MOST_BYTES)


def _secret() -> bytes | None:
    """Return the user's secret, made when there is none; None where it cannot be kept."""
    try:
        state = Path(os.environ.get('XDG_STATE_HOME', ''))
        if not state.is_absolute():
            state = Path.home() / '.local' / 'state'
        file = state / 'husky_playpen_lab' / 'grading_secret'
        return _read_secret(file) or _make_secret(file)
    except (OSError, RuntimeError):  # RuntimeError: there is no home at all
        return None


def _read_secret(file: Path) -> bytes | None:
    try:
        with file.open('rb') as stream:
            about = os.fstat(stream.fileno())
            private = stat.S_ISREG(about.st_mode) and not about.st_mode & 0o077
            if not private or about.st_uid != os.geteuid() or about.st_size != SECRET_BYTES:
                return None
            return stream.read(SECRET_BYTES)
    except FileNotFoundError:
        return None


def _make_secret(file: Path) -> bytes:
    """Make the file anew, whole or not at all, so that two graders at once end up with one."""
    file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    part = file.with_name(f'.{file.name}.{secrets.token_hex(4)}')
    with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), 'wb') as stream:
        stream.write(secrets.token_bytes(SECRET_BYTES))
    part.replace(file)
    return file.read_bytes()


def key_of(file: str, world: str = '') -> str:
    """Return a hash of all that a grade depends on: the file, the world and the programs."""
    digest = _digest_of_programs(world).copy()
    _add(digest, Path(file))
    return digest.hexdigest()


@lru_cache(maxsize=1)
def _digest_of_programs(world: str) -> Any:
    digest = hashlib.sha256()
    for path in _programs_and_worlds(world):
        _add(digest, path)
    return digest


def _add(digest: Any, path: Path) -> None:
    """Add the content of a file; of a device or a pipe, which may never end, only a mark."""
    try:
        digest.update(path.read_bytes() if path.is_file() else b'?')
    except (OSError, ValueError):
        digest.update(b'?')


def _programs_and_worlds(world: str) -> list[Path]:
    from husky_sim.world import default_worlds  # MuJoCo takes its time

    paths: list[Path] = [Path(world)] if world else []
    for package in (husky_course, husky_driver, husky_grader, husky_sim):
        folder = Path(package.__path__[0])
        paths += sorted(path for path in folder.rglob('*') if path.suffix in PROGRAM_ENDINGS)
    return [*paths, *sorted(default_worlds().glob('*.xml'))]
