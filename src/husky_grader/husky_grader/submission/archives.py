# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Read zip and tar archives that somebody hostile may have made.

The libraries extract nothing: the filters of tarfile (PEP 706) came late to Python 3.10 and 3.11,
and have been got round (CVE-2025-4517, python/cpython issues 149486 and 151558). They only read;
sizes that an archive claims are not believed, and no header makes them read much at once.
"""

import bz2
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
import gzip
import io
import lzma
import os
import tarfile
from typing import BinaryIO, cast, IO
import zipfile

from husky_grader.submission.entries import (
    CHUNK_BYTES,
    Entry,
    FILE,
    FOLDER,
    read_chunks,
    refusing_what_is_broken,
    what_is,
)
from husky_grader.submission.kinds import BZIP2, GZIP, XZ
from husky_grader.submission.limits import Meter, Refused

# The list of what a zip holds is read at once: of about 50 000 files.
_ZIP_AT_ONCE = 8 << 20
# A header with long names needs 2 kB. What tarfile does on one can take time that grows with the
# square of its size (CVE-2024-6232).
_TAR_AT_ONCE = CHUNK_BYTES
_UTF_8 = 1 << 11  # APPNOTE.TXT 6.3.10, section 4.4.4: else the name is in code page 437
_ENCRYPTED = 0x1  # APPNOTE.TXT 6.3.10, section 4.4.4
_PLAIN_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)


class _ZipFile(io.BufferedReader):
    """The file of a zip, of which no more is read at once than an honest one needs."""

    def read(self, size: int | None = -1, /) -> bytes:
        whole = size is None or size < 0
        data = super().read(_ZIP_AT_ONCE + 1 if whole else size)
        if len(data) > _ZIP_AT_ONCE:
            raise Refused(
                'its list of files is too long; hand in fewer files; an export of a class is '
                'given unpacked'
            )
        return data


class _Unpacked:
    """The bytes of a tar, counted, read forwards only and never many at once."""

    def __init__(self, stream: IO[bytes], meter: Meter) -> None:
        self.last = b''  # what was read last
        self._stream = stream
        self._meter = meter
        self._position = 0

    def read(self, size: int) -> bytes:
        if not 0 <= size <= _TAR_AT_ONCE:
            raise Refused(f'a header of {size} bytes; pack it again, with zip')
        parts = []
        while size and (part := self._stream.read(size)):
            self._meter.add_bytes(len(part))
            self._position += len(part)
            size -= len(part)
            parts.append(part)
        self.last = b''.join(parts)
        return self.last

    def tell(self) -> int:
        return self._position

    def seek(self, position: int) -> None:
        if position < self._position:
            raise ValueError('a file that begins before another one ends')
        while self._position < position and self.read(min(position - self._position, CHUNK_BYTES)):
            pass

    def read_to_the_end(self) -> None:
        """Read what is left, by which a compressed file checks its sum."""
        while self.read(CHUNK_BYTES):
            pass


@contextmanager
def opened_zip(file: io.FileIO) -> Iterator[zipfile.ZipFile]:
    """
    Open a zip, and close it with its file.

    :raises Refused: when it is broken.
    """
    with _ZipFile(file) as guarded:
        with refusing_what_is_broken():
            archive = zipfile.ZipFile(guarded)
            begins = [info.header_offset for info in archive.infolist()]
            if len(set(begins)) < len(begins):  # newer Pythons print a warning, and read them all
                raise zipfile.BadZipFile('several of its files lie at one place')
            for info in archive.infolist():
                info.filename = _name_of(info)
                archive.NameToInfo[info.filename] = info
        yield archive


def _name_of(info: zipfile.ZipInfo) -> str:
    """Return a name; macOS, and zip without a locale, write UTF-8 and do not say so."""
    if info.flag_bits & _UTF_8:
        return info.filename
    try:
        return info.filename.encode('cp437').decode()
    except UnicodeError:
        return info.filename


def zip_entries(
    archive: zipfile.ZipFile, meter: Meter, chosen: Mapping[str, str] | None = None
) -> Iterator[Entry]:
    """
    Yield what a zip holds.

    :param chosen: the only names of it to be taken, and which paths they get; all when left out.
    :raises Refused: for what is encrypted or packed by a rare method.
    """
    for info in archive.infolist():
        if chosen is None or info.filename in chosen:
            meter.add_entry()
            yield _zip_entry(
                archive, info, (chosen or {}).get(info.filename, info.filename), meter
            )


def _zip_entry(archive: zipfile.ZipFile, info: zipfile.ZipInfo, path: str, meter: Meter) -> Entry:
    path = path.replace('\\', '/')  # what some programs on Windows write, against 4.4.17.1
    if info.flag_bits & _ENCRYPTED:
        raise Refused(f'{path} is encrypted; pack it without a password')
    if info.compress_type not in _PLAIN_METHODS:
        raise Refused(f'{path} is packed by method {info.compress_type}; pack it by deflate')
    mode = info.external_attr >> 16
    what = FOLDER if path.endswith('/') else what_is(mode)
    chunks = partial(read_chunks, partial(archive.open, info), meter)
    return Entry(path, what, chunks, bool(mode & 0o100))


def tar_entries(stream: IO[bytes], meter: Meter) -> Iterator[Entry]:
    """
    Yield what a tar holds, in one pass over it.

    :param stream: not compressed; see `decompressed`.
    :raises Refused: when it is broken or ends too early.
    """
    unpacked = _Unpacked(stream, meter)
    with (
        refusing_what_is_broken(),
        tarfile.open(
            fileobj=cast(BinaryIO, unpacked),
            mode='r:',
            encoding='utf-8',
            errors='surrogateescape',
        ) as archive,
    ):
        for member in archive:
            meter.add_entry()
            yield _tar_entry(archive, member)
        # Where a header is broken, or missing, tarfile ends as it does at the block of zeros.
        if not unpacked.last or unpacked.last.strip(b'\0'):
            raise Refused('broken or incomplete; pack and hand it in again')
        unpacked.read_to_the_end()


def _tar_entry(archive: tarfile.TarFile, member: tarfile.TarInfo) -> Entry:
    if member.size < 0:
        raise ValueError('a size below 0')
    what = 'no file'
    if member.issparse():
        what = 'a sparse file'
    elif member.isreg():
        what = FILE
    elif member.isdir():
        what = FOLDER
    elif member.issym() or member.islnk():
        what = f'a link to {member.linkname}'
    elif member.isdev():
        what = 'a FIFO' if member.isfifo() else 'a device'
    chunks = partial(read_chunks, partial(_open_member, archive, member), None)
    return Entry(member.name, what, chunks, bool(member.mode & 0o100))


def _open_member(archive: tarfile.TarFile, member: tarfile.TarInfo) -> IO[bytes]:
    file = archive.extractfile(member)
    if file is None:
        raise ValueError(f'{member.name} is no file')
    return file


def decompressed(file: io.FileIO, head: bytes) -> IO[bytes]:
    """
    Return the bytes of a file, decompressed where its head says so.

    Memory is bounded by what is read: xz takes none for the part of its window that is not used.
    """
    file.seek(0, os.SEEK_SET)
    if head.startswith(GZIP):
        return cast(IO[bytes], gzip.GzipFile(fileobj=file))
    if head.startswith(BZIP2):
        return bz2.BZ2File(file)
    if head.startswith(XZ):
        return lzma.LZMAFile(file)
    return file
