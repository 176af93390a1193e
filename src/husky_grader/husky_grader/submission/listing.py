# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What lies in an export of an LMS: a folder that was unpacked, or the zip itself."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
import os
from pathlib import Path
from typing import Protocol
import zipfile

from husky_course.files import first_bytes

from husky_grader.submission.archives import opened_zip
from husky_grader.submission.entries import is_left_out, refusing_what_is_broken
from husky_grader.submission.git import is_bare
from husky_grader.submission.kinds import HEAD_BYTES, Kind, kind_of, why_not, without_ending
from husky_grader.submission.limits import Refused
from husky_grader.submission.submission import Submission


class Listing(Protocol):
    """The names in an export, and submissions made of them."""

    @property
    def names(self) -> Sequence[str]:
        """Its paths: of a folder what is directly in it, of a zip all files."""

    def inside(self) -> 'Listing | None':
        """Return what is in the only folder, where there is nothing else."""

    def read(self, name: str, most: int) -> bytes:
        """
        Return the first bytes of a file.

        :raises Refused: when it cannot be read.
        """

    def submission(self, files: Sequence[tuple[str, str]], name: str) -> Submission:
        """
        Return the submission that some of the files are.

        :param files: names here, and the paths that they had where they were handed in.
        :param name: what its id is made of.
        """


class FolderListing:
    """An export that was unpacked."""

    def __init__(self, folder: Path, without: str = '') -> None:
        """
        List it; see `visible`.

        :raises Refused: when it cannot be read.
        """
        self._folder, self._without = folder, without
        self.names = visible(folder, without)

    def inside(self) -> Listing | None:
        if len(self.names) != 1:
            return None
        path = self._folder / self.names[0]
        is_folder = path.is_dir() and not path.is_symlink()
        return FolderListing(path, self._without) if is_folder else None

    def read(self, name: str, most: int) -> bytes:
        return head_of(self._folder / name, most)

    def submission(self, files: Sequence[tuple[str, str]], name: str) -> Submission:
        if len(files) > 1:
            return Submission(name, self._folder, 'folder', files=tuple(files))
        one = submission_at(self._folder / files[0][0], name)
        if one.kind in ('folder', 'git'):
            return one
        return replace(one, source=self._folder, files=tuple(files))


class ZipListing:
    """An export as it was downloaded."""

    def __init__(self, path: Path, archive: zipfile.ZipFile, around: str = '') -> None:
        self._path = path
        self._archive = archive
        self._around = around  # the folder that is listed, with a / at its end
        self.names = sorted(
            name.removeprefix(around)
            for name in archive.namelist()
            if not name.endswith('/') and not any(map(is_left_out, name.split('/')))
        )

    def inside(self) -> Listing | None:
        around = {name.partition('/')[0] for name in self.names if '/' in name}
        if len(around) != 1 or not all('/' in name for name in self.names):
            return None
        return ZipListing(self._path, self._archive, f'{around.pop()}/')

    def read(self, name: str, most: int) -> bytes:
        with refusing_what_is_broken(), self._archive.open(self._around + name) as file:
            return file.read(most)

    def submission(self, files: Sequence[tuple[str, str]], name: str) -> Submission:
        placed = tuple((self._around + given, path) for given, path in files)
        if len(files) > 1:
            return Submission(name, self._path, 'folder', files=placed)
        given, path = files[0]
        try:
            head = self.read(given, HEAD_BYTES)
        except Refused as error:
            return Submission(name, self._path, 'unknown', files=placed, refused=str(error))
        kind = kind_of(head, path)
        if kind == 'unknown' and '/' in path:
            kind = 'folder'
        refused = why_not(head) if kind == 'unknown' else ''
        return Submission(name, self._path, kind, files=placed, refused=refused)


@contextmanager
def listed_zip(path: Path) -> Iterator[ZipListing]:
    """
    Open the listing of a zip.

    :raises Refused: when it is broken.
    """
    with refusing_what_is_broken():
        file = path.open('rb', buffering=0)
    with file, opened_zip(file) as archive:
        yield ZipListing(path, archive)


def visible(folder: Path, without: str = '') -> list[str]:
    """
    Return the names in a folder that people see, in order.

    :param without: the real path of what is passed over.
    :raises Refused: when it cannot be read.
    """
    with refusing_what_is_broken(folder.name):
        names = [path.name for path in folder.iterdir()]
    names = [n for n in names if not (is_left_out(n) or n.startswith('.'))]
    # By os.path: Path.resolve fails where links lead in a circle.
    return sorted(n for n in names if not without or os.path.realpath(folder / n) != without)


def submission_at(path: Path, name: str = '') -> Submission:
    """Return the submission that a file or a folder is; without a name it has its own."""
    kind: Kind = 'unknown'
    refused = ''
    try:
        with refusing_what_is_broken(path.name):
            kind, refused = _kind_at(path)
    except Refused as error:
        refused = str(error)
    own = path.name if kind in ('folder', 'git') else without_ending(path.name)
    return Submission(name or own, path, kind, refused=refused)


def _kind_at(path: Path) -> tuple[Kind, str]:
    """Return what lies there, and why it cannot be taken."""
    if path.is_symlink():
        return 'unknown', 'a link; give what it leads to'
    if path.is_dir():
        return 'git' if (path / '.git').exists() or is_bare(path) else 'folder', ''
    if not path.is_file():
        return 'unknown', 'no file and no folder'
    head = head_of(path, HEAD_BYTES)
    kind = kind_of(head, path.name)
    return kind, why_not(head) if kind == 'unknown' else ''


def head_of(path: Path, most: int) -> bytes:
    """Return the first bytes of a file; Refused where it cannot be read."""
    with refusing_what_is_broken(path.name):
        return first_bytes(path, most)
