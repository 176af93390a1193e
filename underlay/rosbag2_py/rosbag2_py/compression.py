# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Compress by zstd a file of a bag as a whole, or its messages one by one; and read them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rosbag2_py.errors import BagError
from rosbag2_py.storages.interface import Storage, StoredFile

SUFFIX = '.zstd'
"""What the name of a file has behind its own, where it was compressed as a whole."""
MAGIC = b'\x28\xb5\x2f\xfd'
"""What compressed bytes begin with; those of a message in CDR begin with 0."""
_LEVEL = 1  # that of upstream, the fastest


def original(path: Path) -> Path:
    """Return the name that a file had before it was compressed, if it was."""
    return path.with_suffix('') if path.suffix == SUFFIX else path


def read(storage: Storage, path: Path) -> StoredFile:
    """
    Open a file of a bag, as it was before it was compressed.

    That is in the folder for temporary files for as long as it is read, without a name, so that
    nothing is left however that ends.

    :raises BagError: it cannot be read, or is damaged, or there is no room for it.
    """
    if path.suffix != SUFFIX:
        return storage.read(path)
    from tempfile import gettempdir, TemporaryDirectory

    import zstandard

    try:
        compressed = path.open('rb')
    except OSError as error:
        raise BagError(f"'{path}' cannot be read: {error.strerror}") from None
    try:
        with compressed, TemporaryDirectory(prefix='rosbag2_') as folder:
            whole = Path(folder) / path.stem
            with whole.open('wb') as file:
                zstandard.ZstdDecompressor().copy_stream(compressed, file)
            try:
                opened = storage.read(whole)
            except BagError as error:
                raise BagError(str(error).replace(str(whole), str(path))) from None
    except zstandard.ZstdError as error:
        raise BagError(f"'{path}' cannot be decompressed: {error}") from None
    except OSError as error:
        raise BagError(
            f"'{path}' cannot be decompressed into {gettempdir()}: {error.strerror}; TMPDIR names "
            'another folder'
        ) from None
    opened.path = path
    return opened


def compress_file(path: Path) -> Path:
    """
    Put a compressed file in the place of one that is complete; return its name.

    :raises OSError: it cannot be written; the other is still there.
    """
    import zstandard

    packed = path.with_name(path.name + SUFFIX)
    try:
        with path.open('rb') as whole, packed.open('wb') as file:
            size = path.stat().st_size
            zstandard.ZstdCompressor(_LEVEL).copy_stream(whole, file, size=size)
    except BaseException:
        packed.unlink(missing_ok=True)
        raise
    path.unlink()
    return packed


def compressor() -> Callable[[bytes], bytes]:
    """Return what compresses the bytes of a message."""
    import zstandard

    return zstandard.ZstdCompressor(_LEVEL).compress


def decompressed(data: bytes, path: Path) -> bytes:
    """
    Return the bytes of a message that was compressed.

    :param path: the file it is from.
    :raises BagError: they are no such bytes, or do not fit into memory.
    """
    import zstandard

    try:
        return zstandard.ZstdDecompressor().decompress(data)
    except (zstandard.ZstdError, MemoryError) as error:
        raise BagError(f"'{path}' has a message that cannot be decompressed: {error}") from None
