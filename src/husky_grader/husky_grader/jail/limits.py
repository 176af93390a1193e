# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What jailed programs may use."""

from dataclasses import dataclass, fields
import os
import resource

MB = 1_000_000


@dataclass(frozen=True, kw_only=True)
class Limits:
    """
    What may be used: of everything that one call of a jail starts together, if not said otherwise.

    :raises ValueError: for a limit of nothing.
    """

    memory_mb: int = 2000
    tasks: int = 500  # processes and their threads; a node of rclpy has about 15
    computing: int = 16 + 4 * (os.cpu_count() or 1)  # of these at a time; a build takes two a core
    file_mb: int = 200  # one file
    folder_mb: int = 1000  # all that lies in the jail's folder
    files: int = 50_000  # in the jail's folder
    temporary_mb: int = 200  # in /tmp
    shared_mb: int = 64  # in /dev/shm
    open_files: int = 1024  # by one process
    log_mb: float = 2.0  # kept of what is printed: its begin and its end
    cpu_sec: int | None = None  # by one process

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if value is not None and value <= 0:
                raise ValueError(f'{field.name}={value}: a limit is a number above 0')

    def for_each_process(self, *, counts_tasks: bool) -> list[tuple[int, int]]:
        """
        Return the limits that the kernel keeps for each process: numbers of setrlimit(2), values.

        What a process reserves is more than what it uses, so its memory gets twice the limit;
        usage.py holds what is used to the limit itself.
        """
        kept = [
            (resource.RLIMIT_DATA, 2 * self.memory_mb * MB),
            (resource.RLIMIT_FSIZE, self.file_mb * MB),
            (resource.RLIMIT_NOFILE, self.open_files),
            (resource.RLIMIT_CORE, 0),
        ]
        kept += [(resource.RLIMIT_NPROC, self.tasks)] if counts_tasks else []
        kept += [(resource.RLIMIT_CPU, self.cpu_sec)] if self.cpu_sec else []
        return kept
