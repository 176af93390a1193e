# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How much jailed programs use, of what the kernel limits only for each process by itself."""

from collections.abc import Callable, Sequence
from contextlib import suppress
import errno
import io
import os
from pathlib import Path
import stat
import time

from husky_grader.jail.limits import Limits, MB

PROCESSES_SEC = 0.2  # between two looks at the processes
FOLDER_SEC = 1.0  # and at the folder, beside one at the processes, if its disk does not fill
_KIB, _BLOCK_BYTES = 1024, 512  # the units of proc(5) and stat(2)
_NEWS = 0.1  # what a look counts in the mean of the last ones: that spans two seconds or so


class Usage:
    """Looks at processes and at a folder, each time when it is due."""

    def __init__(self, folder: Path, limits: Limits) -> None:
        self._folder, self._limits = folder, limits
        self._processes_at_sec = self._folder_at_sec = time.monotonic()
        self._computing = 0.0  # threads at a time, on the average
        self._room_bytes = _room_bytes(folder)  # when it was last looked at

    def too_much(self, processes: Callable[[], Sequence[int]]) -> str:
        """
        Return in words which limit is exceeded; nothing if none is, or no look is due.

        :param processes: returns the numbers of those that there are.
        """
        now = time.monotonic()
        if now < self._processes_at_sec:
            return ''
        self._processes_at_sec = now + PROCESSES_SEC
        found = processes()
        why = _overuse(found, self._limits) or self._crowding(found)
        if not why and (now >= self._folder_at_sec or self._is_disk_filling()):
            self._folder_at_sec = now + FOLDER_SEC
            self._room_bytes = _room_bytes(self._folder)
            why = _overfull(self._folder, self._limits, found)
        return why

    def _is_disk_filling(self) -> bool:
        """
        Tell whether the disk holds more than a folder may, since the last look at that.

        A look a program can notice, by inotify(7), and have its files there between two.
        """
        taken_bytes = self._room_bytes - _room_bytes(self._folder)
        return taken_bytes > self._limits.folder_mb * MB

    def _crowding(self, processes: Sequence[int]) -> str:
        """
        Return in words that too many compute at a time; nothing if not.

        Among hundreds of them, programs of others on the machine would be late.
        """
        count = sum(map(_computing, processes))
        self._computing += _NEWS * (count - self._computing)
        most = self._limits.computing
        if self._computing > most:
            return f'kept {count} processes and threads computing; {most} at a time are allowed'
        return ''


def _overuse(processes: Sequence[int], limits: Limits) -> str:
    """Return in words what processes use too much of; nothing if they do not."""
    own, shared, tasks = 0, 0, 0
    nameless: dict[int, int] = {}
    for process in processes:
        used = _status_of(process)
        own += used.get('RssAnon', 0) * _KIB
        shared += used.get('RssShmem', 0) * _KIB
        tasks += used.get('Threads', 0)
        nameless |= _nameless_files(process, _is_in_memory)
    memory = own + max(shared, sum(nameless.values()))  # some of these are mapped, too
    if memory > limits.memory_mb * MB:
        return f'used {memory // MB} MB of memory; {limits.memory_mb} MB are allowed'
    if tasks > limits.tasks:
        return f'had {tasks} processes and threads; {limits.tasks} are allowed'
    return ''


def _status_of(pid: int) -> dict[str, int]:
    """Return the numbers of /proc/PID/status; none of a process that has ended."""
    try:
        lines = Path(f'/proc/{pid}/status').read_bytes().split(b'\n')
    except OSError:
        return {}
    words = [line.split() for line in lines]
    # Of bytes, for in a text other digits count, too: a program may have the name ².
    return {
        each[0][:-1].decode(): int(each[1])
        for each in words
        if len(each) > 1 and each[1].isdigit()
    }


def _room_bytes(folder: Path) -> int:
    about = os.statvfs(folder)
    return about.f_bfree * about.f_frsize


def _computing(pid: int) -> int:
    """Return how many threads of a process compute, or wait for a processor: see proc(5)."""
    count = 0
    with suppress(OSError), os.scandir(f'/proc/{pid}/task') as threads:  # it has ended
        for thread in threads:
            with suppress(OSError), io.FileIO(f'{thread.path}/stat') as stat_of:
                count += b') R ' in stat_of.readall()
    return count


def _nameless_files(pid: int, counts: Callable[['os.DirEntry[str]'], bool]) -> dict[int, int]:
    """Return the bytes of each file that a process has open and no folder has, by its inode."""
    found = {}
    with suppress(OSError), os.scandir(f'/proc/{pid}/fd') as links:  # it has ended
        for link in links:
            with suppress(OSError):  # closed meanwhile
                status = link.stat()
                if stat.S_ISREG(status.st_mode) and status.st_nlink == 0 and counts(link):
                    found[status.st_ino] = status.st_blocks * _BLOCK_BYTES
    return found


def _is_in_memory(link: 'os.DirEntry[str]') -> bool:
    return str(Path(link).readlink()).startswith('/memfd:')


def _overfull(folder: Path, limits: Limits, processes: Sequence[int]) -> str:
    """Return in words what a folder, or its disk, holds too much of; nothing if it does not."""
    disk = folder.stat().st_dev
    removed: dict[int, int] = {}
    for process in processes:
        removed |= _nameless_files(process, lambda link: link.stat().st_dev == disk)
    size, files, folders = sum(removed.values()), 0, [str(folder)]
    while folders:
        try:
            with os.scandir(folders.pop()) as entries:
                for entry in entries:
                    files += 1
                    size += _size_of(entry)
                    if files > limits.files:
                        return f'made over {limits.files} files'
                    if entry.is_dir(follow_symlinks=False):
                        folders.append(entry.path)
        except PermissionError:
            return 'closed a folder of its own to everybody'
        except OSError as error:
            if error.errno == errno.ENAMETOOLONG:
                return 'made folders too deep in each other'
            continue  # removed meanwhile
    too_much = size > limits.folder_mb * MB
    return f'filled its folder with over {limits.folder_mb} MB' if too_much else ''


def _size_of(entry: 'os.DirEntry[str]') -> int:
    """Return the bytes that it takes on the disk; what lies beside it counts if it is gone."""
    try:
        return entry.stat(follow_symlinks=False).st_blocks * _BLOCK_BYTES
    except FileNotFoundError:
        return 0
