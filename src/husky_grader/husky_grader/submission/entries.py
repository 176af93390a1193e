# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What an archive or a folder holds, one entry after the other, and what is never taken of it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
import lzma
import os
from pathlib import Path
import stat
import struct
import tarfile
from typing import IO
import zipfile
import zlib

from husky_grader.submission.limits import Meter, Refused

CHUNK_BYTES = 1 << 16
FILE, FOLDER = 'a file', 'a folder'

# What systems and programs leave behind, and what is no work of a student's.
_LEFT_OUT = {
    *('__MACOSX', '.DS_Store', 'Icon\r', 'Thumbs.db', 'desktop.ini', '.git', '.hg', '.svn'),
    *('.venv', 'venv', '__pycache__', '.mypy_cache', '.pytest_cache', '.ruff_cache'),
}
_KINDS = {
    stat.S_IFREG: FILE,
    stat.S_IFDIR: FOLDER,
    stat.S_IFLNK: 'a link',
    stat.S_IFIFO: 'a FIFO',
    stat.S_IFSOCK: 'a socket',
    stat.S_IFCHR: 'a device',
    stat.S_IFBLK: 'a device',
}

# What the libraries raise on bytes that are no archive, or on files that cannot be read.
_BROKEN = (
    *(OSError, EOFError, ValueError, RuntimeError, LookupError, OverflowError, MemoryError),
    *(struct.error, zlib.error, lzma.LZMAError, zipfile.BadZipFile, tarfile.TarError),
)


@dataclass(frozen=True)
class Entry:
    """One file, folder or other thing; it is read before the next one is asked for."""

    path: str  # as it was given, with / between the names
    what: str  # FILE, FOLDER, or in words what else it is
    chunks: Callable[[], Iterator[bytes]]  # the content of a file, checked and counted
    executable: bool = False

    @property
    def name(self) -> str:
        """The last name of its path."""
        return self.path.rpartition('/')[2]


def is_left_out(name: str) -> bool:
    """Tell whether something of this name is never taken, with all that is in it."""
    return name in _LEFT_OUT or name.startswith('._')  # AppleDouble files, RFC 1740


def what_is(mode: int) -> str:
    """Return in words what a mode of a file means; none at all is that of a file."""
    return _KINDS.get(stat.S_IFMT(mode) or stat.S_IFREG, 'no file')


@contextmanager
def refusing_what_is_broken(path: str = '') -> Iterator[None]:
    """
    Turn what goes wrong with the bytes of a submission into its refusal.

    :param path: what its student calls what is read; else the message may have a folder of ours.
    :raises Refused: instead.
    """
    try:
        yield
    except Refused:
        raise
    except PermissionError as error:
        what = path or error.filename or 'it'
        raise Refused(f'{what} may not be read; give the grader the right to') from None
    except _BROKEN as error:
        why = ' '.join(str(error).split()) or type(error).__name__
        raise Refused(f'broken or incomplete ({why}); pack and hand it in again') from None


def read_chunks(
    open_file: Callable[[], IO[bytes]], meter: Meter | None, path: str = ''
) -> Iterator[bytes]:
    """Read a file chunk by chunk; no meter where its bytes are counted already."""
    with refusing_what_is_broken(path), open_file() as file:
        while chunk := file.read(CHUNK_BYTES):
            if meter is not None:
                meter.add_bytes(len(chunk))
            yield chunk


def file_entry(file: Path, path: str, meter: Meter) -> Entry:
    """Return the entry of a file on the disk; a link is not followed."""
    with refusing_what_is_broken(path):
        mode = file.lstat().st_mode

    def chunks() -> Iterator[bytes]:
        return read_chunks(lambda: file.open('rb'), meter, path)

    return Entry(path, what_is(mode), chunks, bool(mode & stat.S_IXUSR))


def folder_entries(folder: Path, meter: Meter) -> Iterator[Entry]:
    """Yield all that a folder holds, in a fixed order; links are not followed."""
    waiting = [(folder, '')]
    while waiting:
        path, given = waiting.pop()
        for name in _names_in(path, given, meter):
            entry = file_entry(path / name, f'{given}{name}', meter)
            yield entry
            if entry.what == FOLDER:
                waiting.append((path / name, f'{given}{name}/'))


def _names_in(folder: Path, given: str, meter: Meter) -> list[str]:
    names = []
    with refusing_what_is_broken(given.rstrip('/')), os.scandir(folder) as found:
        for each in found:
            meter.add_entry()
            if not is_left_out(each.name):
                names.append(each.name)
    return sorted(names)
