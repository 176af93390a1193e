# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write files whole or not at all; read the beginning of what others have written."""

from collections.abc import Iterator
from contextlib import contextmanager
import errno
import os
from pathlib import Path
import stat


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """
    Give the name of a file to write; it takes the place of `path`, unless something fails.

    :raises OSError: with the name of a file, which Python leaves out where a write fails, and of
        `path` for the file to write; also where a device is: root would put the file in the place
        of /dev/null.
    """
    if _is_device(path):
        raise OSError(errno.EEXIST, 'a device, no file', str(path))
    part = path.with_name(f'.{path.stem}.part{path.suffix}')
    try:
        yield part
        part.replace(path)
    except OSError as error:
        if error.filename in (None, str(part)):
            error.filename = str(path)
            if error.filename2:
                del error.filename2  # None would be shown
        elif error.filename2 == str(part):  # of a copy
            error.filename2 = str(path)
        raise
    finally:
        part.unlink(missing_ok=True)


def first_bytes(path: Path, most: int) -> bytes:
    """
    Return the first bytes of a file, and wait for none: /proc/kmsg, to which a link may lead.

    :raises OSError: when it cannot be read.
    """
    with os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK), 'rb') as stream:
        return stream.read(most) or b''  # None where it would have to wait


def _is_device(path: Path) -> bool:
    try:
        mode = path.lstat().st_mode
    except OSError:
        return False
    return stat.S_ISCHR(mode) or stat.S_ISBLK(mode)
