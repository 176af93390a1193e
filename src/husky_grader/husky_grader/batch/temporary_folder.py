# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A temporary folder that stays, where its process is killed, until the next one is made."""

from contextlib import suppress
import fcntl
from glob import escape
import os
from pathlib import Path
import shutil
import tempfile


class TemporaryFolder:
    """
    A folder of this process; those of processes that were killed are removed as it is made.

    A grader that is killed, as where the computer has no more memory, leaves the workspaces of
    its jobs. Whoever has a folder holds a lock of the kernel on it, which ends with the process.
    """

    def __init__(self) -> None:
        # Other computers may have the same disk, and locks of their own.
        prefix = f'husky_grader_{os.uname().nodename}_'
        for left in Path(tempfile.gettempdir()).glob(f'{escape(prefix)}*'):
            _remove_unless_held(left)
        self.path, self._lock = _locked_folder(prefix)

    def remove(self) -> None:
        shutil.rmtree(self.path, ignore_errors=True)
        os.close(self._lock)


def _locked_folder(prefix: str) -> tuple[Path, int]:
    """Return a new folder and its lock; until it has that, another process may remove it."""
    while True:
        folder = Path(tempfile.mkdtemp(prefix=prefix))
        with suppress(FileNotFoundError):
            lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
            with suppress(OSError):  # this disk has no locks, so that nobody removes it either
                fcntl.flock(lock, fcntl.LOCK_EX)
            if folder.is_dir():
                return folder, lock
            os.close(lock)


def _remove_unless_held(folder: Path) -> None:
    try:
        lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except OSError:  # no folder, or that of another user
        return
    try:
        if os.fstat(lock).st_uid == os.geteuid():
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(folder, ignore_errors=True)
    except OSError:  # it is in use
        return
    finally:
        os.close(lock)
