# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Remove the shared memory of Fast DDS that killed participants leave.

A participant makes files fastrtps_NAME, fastrtps_NAME_el and sem.fastrtps_NAME_mutex in /dev/shm.
One that is killed leaves them, and the clean-up of the next one removes half of them.
"""

import os
from pathlib import Path
import time

_FOLDER = Path('/dev/shm')
_MARK = 'fastrtps_'
_CAP_SYS_PTRACE = 19  # <linux/capability.h>
_MADE_SEC = 0.2  # a younger file may not be mapped yet


def clean_shared_memory() -> None:
    """Remove the files of this user that no process has mapped or locked."""
    if not Path('/proc/self/maps').exists():  # not Linux
        return
    # A second look and no deadline: on a busy machine one look at all processes takes long.
    if young_sec := _remove_older():
        time.sleep(max(0.0, _MADE_SEC - young_sec[0]))
        _remove_older()


def _remove_older() -> list[float]:
    """Remove the unused files that are older than the time to map one; return the others' ages."""
    files = unused_files()
    young = {file: age_sec for file, age_sec in files.items() if age_sec <= _MADE_SEC}
    being_made = {_stem_of(file.name) for file in young}
    for file in files:
        if _stem_of(file.name) not in being_made:
            file.unlink(missing_ok=True)
    return sorted(young.values())


def unused_files() -> dict[Path, float]:
    """Return the age of every file of this user that nobody uses, as far as one sees."""
    files = list(_FOLDER.glob(f'*{_MARK}*'))
    if not files:
        return {}
    maps = [_maps_of(process) for process in Path('/proc').glob('[0-9]*')]
    # In a container root may have fewer rights than another root, whose files these may be.
    if None in maps and os.geteuid() == 0 and not _may_trace():
        return {}
    mapped = ''.join(filter(None, maps))
    # What follows is quick, and comes last: ports have names that come again, and who takes that
    # of a dead one while all maps are read has it locked, or made anew.
    ages: dict[Path, float] = {}
    used: set[str] = set()
    locked = _locked_inodes()
    for file in files:
        try:
            status = file.stat()
        except OSError:  # removed meanwhile
            continue
        if status.st_uid == os.getuid():
            # Of one from the future, the clock was set back: it is not being made now.
            ages[file] = abs(time.time() - status.st_mtime)
            # A busy machine may take long from the lock on NAME_el to the map of NAME.
            if status.st_ino in locked:
                used.add(_stem_of(file.name))
    stems = {file: _stem_of(file.name) for file in ages}
    return {
        file: ages[file] for file, stem in stems.items() if stem not in mapped and stem not in used
    }


def _locked_inodes() -> set[int]:
    """Return the inodes of all files that a process has locked: proc_locks(5)."""
    try:
        locks = Path('/proc/locks').read_text()
    except OSError:
        return set()
    return {int(line.split()[-3].rpartition(':')[2]) for line in locks.splitlines()}


def _stem_of(name: str) -> str:
    rest = name.partition(_MARK)[2]
    return _MARK + (rest.rpartition('_')[0] or rest)


def _maps_of(process: Path) -> str | None:
    """Return what a process has mapped; None if it does not show it."""
    try:
        return (process / 'maps').read_text()
    except PermissionError:
        return None
    except OSError:  # it has ended
        return ''


def _may_trace() -> bool:
    """Tell whether this process may look into all others of its namespace: capabilities(7)."""
    status = Path('/proc/self/status').read_text(encoding='utf-8')
    rights = next(line.split()[1] for line in status.splitlines() if line.startswith('CapEff:'))
    return bool(int(rights, 16) >> _CAP_SYS_PTRACE & 1)
