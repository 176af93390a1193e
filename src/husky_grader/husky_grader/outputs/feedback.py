# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Archives of feedback: the same bytes from the same files, whoever makes them and when."""

from collections.abc import Iterable, Mapping
import gzip
import io
from pathlib import Path
import tarfile
import zipfile

from husky_course.files import replacing

_EARLIEST = (1980, 1, 1, 0, 0, 0)  # that a zip can say
_PLAIN_FILE = 0o644


def write_zip(path: Path, files: Iterable[tuple[str, bytes]]) -> None:
    """
    Write a zip, whole or not at all.

    :raises OSError: when it cannot be written.
    """
    with replacing(path) as part, part.open('wb') as stream:
        _zip_into(stream, files)


def as_zip(files: Mapping[str, bytes]) -> bytes:
    stream = io.BytesIO()
    _zip_into(stream, files.items())
    return stream.getvalue()


def as_tar_gz(files: Mapping[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode='w') as archive:
        for name, content in files.items():
            entry = tarfile.TarInfo(name)
            entry.size, entry.mode = len(content), _PLAIN_FILE
            archive.addfile(entry, io.BytesIO(content))
    return gzip.compress(stream.getvalue(), mtime=0)


def _zip_into(stream: io.BufferedIOBase, files: Iterable[tuple[str, bytes]]) -> None:
    with zipfile.ZipFile(stream, 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, content in files:
            entry = zipfile.ZipInfo(name, _EARLIEST)
            entry.external_attr = _PLAIN_FILE << 16
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)
