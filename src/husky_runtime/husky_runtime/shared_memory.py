# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Remove the shared memory of Fast DDS that killed participants leave.

A participant makes files fastrtps_NAME and fastrtps_NAME_el in /dev/shm, and for ports, whose
names come again, sem.fastrtps_NAME_mutex. One that is killed leaves them, and the clean-up of the
next one removes half of them.
"""

from contextlib import closing, suppress
import math
import os
from pathlib import Path
import re
import time

from husky_runtime.domains import Lock
from husky_runtime.shared_memory_ports import FOLDER, free_half_made_ports, Mutex, PORT

_MARK = 'fastrtps_'
_NAME = re.compile(rf'{_MARK}[^\s/]+')
_CAP_SYS_PTRACE = 19  # <linux/capability.h>
_MADE_SEC = 0.2  # a younger file may not be mapped yet
_LOCK_SEC, _POLL_SEC = 5.0, 0.01  # of waiting for another clean-up
OF_A_RUN_MB = 4  # enough for a drive with its page and two commands that look on
OF_A_SIMULATOR_MB = 2  # for itself, a driver and a command: those of a drive start beside it
OF_A_NODE_MB = 1


def check_shared_memory(needed_mb: int = OF_A_RUN_MB) -> None:
    """
    Check that there is room for the messages of a run.

    Where some of its nodes get shared memory and the next gets none, what they send is lost in
    silence; where none does, Fast DDS falls back to UDP.

    :raises ValueError: if there is too little.
    """
    if lacks_shared_memory(needed_mb):
        clean_shared_memory()
        if lacks_shared_memory(needed_mb):
            raise ValueError(
                f'{FOLDER} has less than {needed_mb} MB left, too few for the messages of a run: '
                'remove what is not needed there, or give a container more (--shm-size=64m)'
            )


def sends_by_shared_memory() -> bool:
    """Return whether a node does, in this process's environment."""
    given = os.environ.get
    if given('ROS_AUTOMATIC_DISCOVERY_RANGE') == 'LOCALHOST' or given('ROS_LOCALHOST_ONLY') == '1':
        return True  # rmw_fastrtps adds it, whatever a profile says
    profile = given('FASTRTPS_DEFAULT_PROFILES_FILE')
    return not (profile or given('FASTDDS_BUILTIN_TRANSPORTS', '').startswith('UDP'))


def lacks_shared_memory(needed_mb: int) -> bool:
    """Return whether Fast DDS is used and has less left than this."""
    middleware = os.environ.get('RMW_IMPLEMENTATION') or 'rmw_fastrtps_cpp'  # empty is unset
    if not middleware.startswith('rmw_fastrtps'):
        return False
    try:
        status = os.statvfs(FOLDER)
    except OSError:  # not Linux
        return False
    # One without a limit tells of no blocks at all.
    return status.f_blocks > 0 and status.f_bavail * status.f_frsize < needed_mb * 1_000_000


def clean_shared_memory() -> None:
    """Remove the files of this user that no process has mapped or locked."""
    if not Path('/proc/self/maps').exists():  # not Linux
        return
    # A second time and no deadline: on a busy machine one look at all processes takes long.
    with suppress(BlockingIOError):
        if young_sec := _remove_older():
            time.sleep(_MADE_SEC - young_sec[0])
            _remove_older()


def _remove_older() -> list[float]:
    """
    Remove the unused files that are older than the time to map one; return the others' ages.

    :raises BlockingIOError: if others do the same for too long.
    """
    with closing(wait_for_lock()):
        free_half_made_ports()
        ages = unused_files()
        if old := _older(ages):
            _remove(old)
    return sorted(age_sec for age_sec in ages.values() if age_sec <= _MADE_SEC)


def _remove(files: set[Path]) -> None:
    """Remove what is unused of these files also while nobody can open a port."""
    # Who opens a port takes its mutex first. One that cannot be taken here is in the hands of a
    # process that has it mapped, or has ended: no other clean-up is at work.
    stems = {_stem_of(file.name) for file in files}
    taken = [mutex for stem in stems if stem.startswith(PORT) and (mutex := Mutex(stem)).take()]
    try:
        unused = files & _older(unused_files())
        mutexes = {Mutex(_stem_of(file.name)).file for file in unused}
        for file in unused - mutexes:
            file.unlink(missing_ok=True)
    finally:
        for mutex in taken:
            mutex.release()
    for file in mutexes:
        file.unlink(missing_ok=True)


def wait_for_lock() -> Lock:
    """
    Wait until no other clean-up of this user is at work.

    :raises BlockingIOError: if one is for too long.
    """
    deadline = time.monotonic() + _LOCK_SEC
    while True:
        try:
            return Lock(f'clean_shared_memory_{os.getuid()}')
        except BlockingIOError:
            if time.monotonic() > deadline:
                raise
        time.sleep(_POLL_SEC)


def _older(ages: dict[Path, float]) -> set[Path]:
    """Return the files of which all with the same stem are older than the time to map one."""
    being_made = {_stem_of(file.name) for file, age_sec in ages.items() if age_sec <= _MADE_SEC}
    return {file for file in ages if _stem_of(file.name) not in being_made}


def unused_files() -> dict[Path, float]:
    """
    Return the files of this user that nobody uses, as far as one sees.

    With them their ages when the look began, in seconds: negative for what was made since.
    """
    begun_sec = time.time()
    if not any(FOLDER.glob(f'*{_MARK}*')):
        return {}
    maps = [_maps_of(process) for process in Path('/proc').glob('[0-9]*')]
    # In a container root may have fewer rights than another root, whose files these may be.
    if None in maps and os.geteuid() == 0 and not _may_trace():
        return {}
    # What follows is quick, and comes last: ports have names that come again, and who takes that
    # of a dead one while all maps are read has it locked, or made anew.
    ages: dict[Path, float] = {}
    used = {_stem_of(name) for text in filter(None, maps) for name in _NAME.findall(text)}
    locked = _locked_inodes()
    for file in FOLDER.glob(f'*{_MARK}*'):
        try:
            status = file.stat()
        except OSError:  # removed meanwhile
            continue
        if status.st_uid == os.getuid():
            # Of one from the future, the clock was set back: it is not being made now.
            is_possible = status.st_mtime <= time.time()
            ages[file] = begun_sec - status.st_mtime if is_possible else math.inf
            # A busy machine may take long from the lock on NAME_el to the map of NAME.
            if status.st_ino in locked:
                used.add(_stem_of(file.name))
    return {file: age_sec for file, age_sec in ages.items() if _stem_of(file.name) not in used}


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
