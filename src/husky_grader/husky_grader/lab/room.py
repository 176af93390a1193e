# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whether files can be written: what fails for want of room is not the student's fault."""

import os
from pathlib import Path
from tempfile import TemporaryFile

ROOM_BYTES = 10_000_000
"""A build that found no room may leave less than it asked for."""


def check_room(*folders: Path) -> None:
    """
    Check that there is room in some folders: on the disk, and in the quota of the user.

    :raises OSError: with the name of the folder in which there is none.
    """
    for folder in folders:
        try:
            with TemporaryFile(buffering=0, dir=folder) as file:
                left = memoryview(bytes(ROOM_BYTES))
                while left:
                    left = left[file.write(left) :]
                os.fsync(file.fileno())  # of a network's disk, this says it at the earliest
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(folder)) from None
