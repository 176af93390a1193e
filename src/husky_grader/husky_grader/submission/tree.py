# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write what was handed in as plain files and folders, under names that are safe."""

from collections.abc import Sequence
from pathlib import Path, PureWindowsPath
import unicodedata

from husky_course.printable import printable

from husky_grader.submission.entries import Entry, FILE, FOLDER, is_left_out
from husky_grader.submission.limits import Meter, Refused

Parts = tuple[str, ...]
"""A path below the folder, name by name; () is the folder itself."""

PASSABLE = 0o755
"""Whatever the umask: in a jail another user reads what was handed in."""

_LONGEST_NAME = 255  # bytes: NAME_MAX of Linux file systems
_NOT_IN_NAMES = ('Cc', 'Cs', 'Zl', 'Zp')  # control characters, no UTF-8, ends of lines


def shown(parts: Parts) -> str:
    """Return a path as a message shows it."""
    path = '/'.join(parts)
    return printable(path if len(path) <= 100 else f'{path[:40]}...{path[-40:]}')


def common_start(paths: Sequence[Parts]) -> Parts:
    """Return the folders that all of some paths begin with."""
    least, most = min(paths), max(paths)
    depth = 0
    while depth < len(least) and least[depth] == most[depth]:
        depth += 1
    return least[:depth]


class TreeWriter:
    """
    Writes entries into a new folder, and remembers what it has written and what it has not.

    Only files and folders are made, so that no path leads out of the folder.
    """

    def __init__(self, folder: Path, meter: Meter) -> None:
        folder.mkdir()
        folder.chmod(PASSABLE)
        self.files: list[Parts] = []
        self.others: dict[Parts, str] = {}  # links, devices, ...: what they are; not written
        self._folder = folder
        self._meter = meter
        self._folders: set[Parts] = {()}
        self._taken: dict[str, Parts] = {}  # by a name that is the same on every file system

    def add(self, entry: Entry) -> None:
        """
        Write an entry, unless it is of what is always left out.

        :raises Refused: for names that are not safe, and for what is above a limit.
        :raises OSError: when it cannot be written.
        """
        parts = _parts(entry.path)
        if any(map(is_left_out, parts)):
            return
        self._check(parts)
        if entry.what == FOLDER:
            self._make_folder(parts)
        elif not parts:
            raise Refused('a file without a name; pack it again, with zip')
        elif entry.what == FILE:
            self._make_folder(parts[:-1])
            self._write(parts, entry)
        else:
            self.others[parts] = entry.what

    def _check(self, parts: Parts) -> None:
        path = '/'.join(parts)
        if any(unicodedata.category(char) in _NOT_IN_NAMES for char in path):
            raise Refused(f'the name {shown(parts)} has bytes that are no text; rename it')
        longest = max((len(part.encode()) for part in parts), default=0)
        limits = self._meter.limits
        if longest > _LONGEST_NAME or len(path.encode()) > limits.path_bytes:
            raise Refused(f'the name {shown(parts)} is too long; rename it')
        if len(parts) > limits.depth:
            raise Refused(
                f'{shown(parts)}: more than {limits.depth} folders in each other; hand in the '
                'workspace only'
            )

    def _make_folder(self, parts: Parts) -> None:
        if parts not in self._folders:
            self._make_folder(parts[:-1])
            self._take(parts)
            path = self._folder.joinpath(*parts)
            path.mkdir()
            path.chmod(PASSABLE)
            self._folders.add(parts)

    def _take(self, parts: Parts) -> None:
        key = unicodedata.normalize('NFC', '/'.join(parts)).casefold()
        other = self._taken.setdefault(key, parts)
        if other is not parts:
            twice = f'{shown(parts)} is in it twice; pack it again, with zip'
            alike = f'{shown(other)} and {shown(parts)} are one name on some systems; rename one'
            raise Refused(twice if other == parts else alike)

    def _write(self, parts: Parts, entry: Entry) -> None:
        self._take(parts)
        path, size = self._folder.joinpath(*parts), 0
        with path.open('xb') as file:
            for chunk in entry.chunks():
                size += len(chunk)
                self._meter.check_file(entry.path, size)
                file.write(chunk)
        path.chmod(PASSABLE if entry.executable else 0o644)
        self.files.append(parts)


def _parts(path: str) -> Parts:
    """
    Return the names in a path.

    :raises Refused: for one that leads elsewhere, here or on Windows.
    """
    windows = PureWindowsPath(path)
    if windows.anchor or '..' in windows.parts:
        raise Refused(
            f'{shown((path,))} leads out of its folder; pack it again, from the folder above it'
        )
    return tuple(part for part in path.split('/') if part not in ('', '.'))
