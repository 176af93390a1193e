# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How much one submission may be, and the refusal of what is more."""

from dataclasses import dataclass
import time

FOLDERS_OF_COLCON = ('build', 'install', 'log')
COPY, BUILT, IGNORED = 'handed_in', 'built', 'COLCON_IGNORE'
"""
Folders of a report: the copy of a workspace, what is built of it, meanwhile; and a file in them.

A report may lie in the workspace itself: neither colcon nor the next grading takes these then.
"""
LEAVE_OUT = f'leave out {", ".join(FOLDERS_OF_COLCON)}, environments and recordings'


class Refused(ValueError):
    """A submission that cannot be taken; the message is one line for a person."""


@dataclass(frozen=True)
class Limits:
    """How much one submission may be, unpacked."""

    entries: int = 20_000  # files and folders, also those that are left out
    total_bytes: int = 200_000_000
    file_bytes: int = 100_000_000
    path_bytes: int = 1_000
    depth: int = 32  # names in a path
    cpu_sec: float = 60.0  # processor time of the thread that unpacks it


class Meter:
    """Counts what is read of one submission, and stops at its limits."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self._entries = 0
        self._bytes = 0
        self._until_sec = time.thread_time() + limits.cpu_sec

    def add_entry(self) -> None:
        """
        Count a file or a folder.

        :raises Refused: when it is one too many, or reading has taken too long.
        """
        self._entries += 1
        if self._entries > self.limits.entries:
            raise Refused(f'more than {self.limits.entries} files and folders; {LEAVE_OUT}')
        self._check_time()

    def add_bytes(self, count: int) -> None:
        """
        Count what was unpacked.

        :raises Refused: when it is too much, or reading has taken too long.
        """
        self._bytes += count
        if self._bytes > self.limits.total_bytes:
            raise Refused(f'more than {_megabytes(self.limits.total_bytes)} unpacked; {LEAVE_OUT}')
        self._check_time()

    def check_file(self, name: str, size: int) -> None:
        """
        Check the size of one file.

        :raises Refused: when it is too large.
        """
        if size > self.limits.file_bytes:
            allowed = _megabytes(self.limits.file_bytes)
            raise Refused(f'{name} is larger than {allowed}; {LEAVE_OUT}')

    def _check_time(self) -> None:
        if time.thread_time() > self._until_sec:
            raise Refused(
                f'unpacking takes more than {self.limits.cpu_sec:g} s of processor time; pack it '
                'again, with zip'
            )


def _megabytes(size: int) -> str:
    return f'{size / 1e6:g} MB'
