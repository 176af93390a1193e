# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What an archive or a folder holds, one entry after the other, and what is never taken of it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
import errno
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
    return _entry_at(Path(os.path.realpath(file.parent), file.name), path, meter)


def folder_entries(folder: Path, meter: Meter) -> Iterator[Entry]:
    """Yield all that a folder holds, in a fixed order; links are not followed."""
    waiting = [(Path(os.path.realpath(folder)), '')]
    while waiting:
        path, given = waiting.pop()
        for name in _names_in(path, given, meter):
            entry = _entry_at(path / name, f'{given}{name}', meter)
            yield entry
            if entry.what == FOLDER:
                waiting.append((path / name, f'{given}{name}/'))


def _entry_at(place: Path, path: str, meter: Meter) -> Entry:
    with refusing_what_is_broken(path):
        mode = place.lstat().st_mode

    def chunks() -> Iterator[bytes]:
        return read_chunks(lambda: os.fdopen(_opened(place, path), 'rb'), meter, path)

    return Entry(path, what_is(mode), chunks, bool(mode & stat.S_IXUSR))


def _names_in(folder: Path, given: str, meter: Meter) -> list[str]:
    names = []
    path = given.rstrip('/')
    with refusing_what_is_broken(path):
        opened = _opened(folder, path or folder.name, stat.S_IFDIR)
        try:
            with os.scandir(opened) as found:
                for each in found:
                    meter.add_entry()
                    if not is_left_out(each.name):
                        names.append(each.name)
        finally:
            os.close(opened)
    return sorted(names)


def _opened(place: Path, path: str, kind: int = stat.S_IFREG) -> int:
    """
    Open what was found at a real path, a file or a folder, and nothing that lies there by now.

    Where students can write, one may put a link there, to a file that only the grader may read,
    or a pipe, which to open could take for ever.

    :raises Refused: when it is another.
    """
    changed = f'{path} changed while it was read; grade a copy that nobody else can write'
    try:
        opened = os.open(place, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as error:
        if error.errno in (errno.ELOOP, errno.ENOENT, errno.ENOTDIR, errno.ENXIO):
            raise Refused(changed) from None
        raise
    try:
        here = place
        with suppress(FileNotFoundError):  # where there is no /proc
            here = Path(f'/proc/self/fd/{opened}').readlink()  # folders above may be others, too
        if here != place or stat.S_IFMT(os.fstat(opened).st_mode) != kind:
            raise Refused(changed)
    except BaseException:
        os.close(opened)
        raise
    return opened
