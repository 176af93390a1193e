# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which files of Fast DDS's shared memory are a run's own, whatever else runs on the machine."""

from collections.abc import Iterable
from pathlib import Path
import re

Files = dict[Path, int]  # and their inodes: a name that is free is taken by the next process


def own_files(pids: Iterable[int]) -> Files:
    """Return the files that these processes have mapped, and no other process has."""
    ours = set(pids)
    others = mapped_by(_all_pids() - ours)
    return {path: inode for path, inode in mapped_by(ours).items() if path not in others}


def without_common_ports(files: Files) -> Files:
    """
    Leave out the ports that nodes of every domain try, which begin at 7000; a domain's at 7400.

    Fast DDS 2.14 leaves one, for the next who takes it, where its process ends while another looks
    at it: that one counts as a user of it, so that nobody is the last.
    """
    common = re.compile('fastrtps_port7[0-3][0-9]{2}')
    return {path: inode for path, inode in files.items() if not common.fullmatch(path.name)}


def left(files: Files) -> list[str]:
    """Return which of the files are still there, with nobody who uses them."""
    there = {path for path, inode in files.items() if _inode(path) == inode}
    unused = there - mapped_by(_all_pids()).keys()
    # Who had one mapped may have removed it while the maps of all were read.
    return sorted(path.name for path in unused if _inode(path) == files[path])


def lost(files: Files) -> list[str]:
    """Return which of the files, that a process has, nobody else finds any more."""
    return sorted(path.name for path, inode in files.items() if _inode(path) != inode)


def _inode(path: Path) -> int | None:
    try:
        return path.stat().st_ino
    except OSError:  # gone meanwhile
        return None


def _all_pids() -> set[int]:
    return {int(process.name) for process in Path('/proc').glob('[0-9]*')}


def mapped_by(pids: Iterable[int]) -> Files:
    """Return the files that any of these processes has mapped."""
    files: Files = {}
    for pid in pids:
        try:
            rows = Path(f'/proc/{pid}/maps').read_text().splitlines()
        except OSError:  # it has ended meanwhile
            continue
        for inode, file in (row.split()[4:6] for row in rows if '/dev/shm/' in row):  # proc(5)
            if 'fastrtps_' in file:
                files[Path(file)] = int(inode)
    return files
