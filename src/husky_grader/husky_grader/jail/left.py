# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read what jailed programs have left in their folder."""

import os
from pathlib import Path
import stat


class NotAFile(ValueError):
    """What was left is no file to read; the message says what it is."""


def read_left(folder: Path, name: str, *, most_bytes: int) -> bytes:
    """
    Return the content of a regular file in a folder: a link leads out of it, a pipe never ends.

    Nobody may write there meanwhile.

    :param name: relative to the folder.
    :raises NotAFile: if it is anything else, larger than allowed, or not there.
    """
    path = Path(folder, name)
    if path.resolve() != folder.resolve() / name:
        raise NotAFile(f'{name}: leads elsewhere by a link; put the file itself there')
    try:
        # A pipe without a writer is opened at once, and refused below.
        with os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW), 'rb') as file:
            about = os.fstat(file.fileno())
            if not stat.S_ISREG(about.st_mode):
                raise NotAFile(f'{name}: is no regular file; only such are read')
            if about.st_size > most_bytes:
                raise NotAFile(f'{name}: has {about.st_size} bytes; {most_bytes} are allowed')
            return file.read(most_bytes)
    except OSError as error:
        raise NotAFile(
            f'{name}: {error.strerror}; a file that can be read must be there'
        ) from None
