# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Remember what was graded, so that it is not done twice.

A report is believed only with a seal that nobody can make who does not have the grader's secret:
an HMAC (RFC 2104) over what the grade depends on and the report itself. The secret is a file that
only the user can read; where it cannot be kept, everything is graded again.
"""

from __future__ import annotations

import hmac
import json
import os
from pathlib import Path
import secrets
import stat
from typing import Any

from husky_grader.report.report import is_report

SEAL_FILE = '.graded'
SECRET_BYTES = 32
MOST_BYTES = 64_000_000  # of a report, whose run may have been a day long


class Memory:
    """Seals reports, and knows its own seals again."""

    def __init__(self) -> None:
        self._secret = _secret()

    def recall(self, folder: Path, key: str) -> dict[str, Any] | None:
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

    def remember(self, folder: Path, key: str) -> None:
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
    Return what a file holds, if it is one: a pipe or a device may never end.

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
        return _kept(file) or _made(file)
    except (OSError, RuntimeError):  # RuntimeError: there is no home at all
        return None


def _kept(file: Path) -> bytes | None:
    try:
        with file.open('rb') as stream:
            about = os.fstat(stream.fileno())
            private = stat.S_ISREG(about.st_mode) and not about.st_mode & 0o077
            if not private or about.st_uid != os.geteuid() or about.st_size != SECRET_BYTES:
                return None
            return stream.read(SECRET_BYTES)
    except FileNotFoundError:
        return None


def _made(file: Path) -> bytes:
    """Make the file anew, whole or not at all, so that two graders at once end up with one."""
    file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    part = file.with_name(f'.{file.name}.{secrets.token_hex(4)}')
    with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), 'wb') as stream:
        stream.write(secrets.token_bytes(SECRET_BYTES))
    part.replace(file)
    return file.read_bytes()
