# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How the files of a bag are stored; what a storage is made of is loaded when it is used."""

from __future__ import annotations

from pathlib import Path

from rosbag2_py.errors import BagError
from rosbag2_py.storages.interface import FileWriter, Storage, StoredFile

DEFAULT_ID = 'mcap'


def _read_mcap(path: Path) -> StoredFile:
    from rosbag2_py.storages.mcap_file import McapFile

    return McapFile(path)


def _write_mcap(path: Path, preset: str) -> FileWriter:
    from rosbag2_py.storages.mcap_writer import McapWriter

    return McapWriter(path, preset)


def _read_sqlite(path: Path) -> StoredFile:
    from rosbag2_py.storages.sqlite_file import SqliteFile

    return SqliteFile(path)


def _write_sqlite(path: Path, preset: str) -> FileWriter:
    from rosbag2_py.storages.sqlite_writer import SqliteWriter

    return SqliteWriter(path, preset)


STORAGES = {
    each.id: each
    for each in (
        Storage(
            id='mcap',
            suffix='.mcap',
            magic=b'\x89MCAP0\r\n',
            presets=('none', 'fastwrite', 'zstd_fast', 'zstd_small'),
            smallest_file_bytes=1024,
            read=_read_mcap,
            write=_write_mcap,
        ),
        Storage(
            id='sqlite3',
            suffix='.db3',
            magic=b'SQLite format 3\0',
            presets=('none', 'resilient'),
            smallest_file_bytes=86016,
            read=_read_sqlite,
            write=_write_sqlite,
        ),
    )
}
"""By the names that storage_id has for them."""


def storage_of(storage_id: str) -> Storage:
    """
    Return the storage of that name.

    :raises BagError: there is none here.
    """
    if storage_id not in STORAGES:
        known = ' or '.join(repr(each) for each in STORAGES)
        raise BagError(
            f"storage_id='{storage_id}': bags are stored as {known} here, other storages need a "
            'full ROS 2'
        )
    return STORAGES[storage_id]
