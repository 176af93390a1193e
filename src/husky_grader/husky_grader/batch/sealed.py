# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Results of earlier calls and of other machines, so that nothing is graded twice.

A result is taken only with a seal that needs the grader's secret: an HMAC (RFC 2104) over its key
and the result itself. The secret is a file that only the user can read, or in a variable of the
environment, by which several machines share one; where there is none, everything is graded again.
"""

import hmac
import json
import os
from pathlib import Path
import secrets
import stat
from typing import Any

from husky_grader.batch.job import Job

SEAL_FILE = '.graded'
SECRET_BYTES = 32
SECRET_VARIABLE = 'HUSKY_GRADING_SECRET'
MOST_BYTES = 64_000_000  # of a report, whose run may have been a day long


class Seals:
    """Seals results, and loads those whose seal is right."""

    def __init__(self) -> None:
        """
        Take the secret.

        :raises ValueError: if that of the environment is too short to be one.
        """
        self._secret = _shared_secret() or _secret()

    def load(self, folder: Path, job: Job, key: str) -> dict[str, Any] | None:
        """Return the result in a folder if it was sealed with this key."""
        try:
            text = _content(folder / job.result_file)
            seal = _content(folder / SEAL_FILE).decode('ascii')
            if self._secret is None or not hmac.compare_digest(seal, self._seal(key, text)):
                return None
            result = json.loads(text)
        except (OSError, ValueError, TypeError, RecursionError):
            return None
        return result if job.is_result(result) else None

    def seal(self, folder: Path, job: Job, key: str) -> None:
        """
        Seal the result in a folder.

        :raises OSError: when it cannot be written.
        """
        if self._secret is not None:
            text = (folder / job.result_file).read_bytes()
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
        return stream.read(about.st_size)  # for more, room would be made each time


def _shared_secret() -> bytes:
    secret = os.environ.get(SECRET_VARIABLE, '').encode()
    if 0 < len(secret) < SECRET_BYTES:
        raise ValueError(
            f'{SECRET_VARIABLE} has {len(secret)} characters; give {SECRET_BYTES} or more, as '
            '"openssl rand -hex 32" prints them'
        )
    return secret


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
    try:
        os.link(part, file)  # that of the first stays, where several have found none
    except OSError:  # there is one, or this file system has no links
        if found := _read_secret(file):
            part.unlink()
            return found
        part.replace(file)
    else:
        part.unlink()
    return file.read_bytes()
