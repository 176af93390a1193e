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
_MADE_SEC = 0.2  # a younger file may not be mapped yet


def clean_shared_memory() -> None:
    """Remove the files of this user that no process has mapped."""
    if not Path('/proc/self/maps').exists():  # not Linux
        return
    deadline = time.monotonic() + 2 * _MADE_SEC
    while (files := unused_files()) and time.monotonic() < deadline:
        for file, age_sec in files.items():
            if age_sec > _MADE_SEC:
                file.unlink(missing_ok=True)
        time.sleep(_MADE_SEC / 10)


def unused_files() -> dict[Path, float]:
    """Return the age of every file of this user that no process has mapped."""
    ages: dict[Path, float] = {}
    for file in _FOLDER.glob(f'*{_MARK}*'):
        try:
            status = file.stat()
        except OSError:  # removed meanwhile
            continue
        if status.st_uid == os.getuid():
            ages[file] = time.time() - status.st_mtime
    if not ages:
        return ages
    mapped = ''.join(map(_maps_of, Path('/proc').glob('[0-9]*')))
    return {file: age for file, age in ages.items() if _stem_of(file.name) not in mapped}


def _stem_of(name: str) -> str:
    rest = name.partition(_MARK)[2]
    return _MARK + (rest.rpartition('_')[0] or rest)


def _maps_of(process: Path) -> str:
    try:
        return (process / 'maps').read_text()
    except OSError:  # it has ended, or belongs to another user
        return ''
