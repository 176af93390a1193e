# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Open a database that anybody may have made, and say in words what is wrong with it."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
import sqlite3

from rosbag2_py.errors import BagError

_MAGIC = b'SQLite format 3\0'
_WAL_VERSION = 2
_READ_VERSION_AT = 19
_BUSY_SEC = 2.0
_BESIDE = (
    "'{beside}' beside it, which belongs to it, cannot be taken in here: copy both to a folder "
    'that may be written and call `sqlite3 COPY .tables`'
)


def opened(path: Path) -> sqlite3.Connection:
    """
    Open a file to be read alone.

    :raises BagError: it cannot be read, or is no database.
    """
    options = f'?mode=ro{"&immutable=1" * _is_at_rest(path)}'
    with in_words(path):
        connection = sqlite3.connect(
            path.absolute().as_uri() + options,
            uri=True,
            timeout=_BUSY_SEC,
            isolation_level=None,
            check_same_thread=False,
        )
        try:
            # What is in the schema calls no function that could do harm, and damage is found.
            for pragma in ('trusted_schema = OFF', 'cell_size_check = ON', 'mmap_size = 0'):
                connection.execute(f'PRAGMA {pragma}')
        except BaseException:
            connection.close()
            raise
        return connection


def log_of(path: Path) -> Path:
    """Return where the write-ahead log of a file is, if it has one."""
    return path.with_name(f'{path.name}-wal')


def has_log(path: Path) -> bool:
    """Tell whether messages of a file are in its write-ahead log."""
    log = log_of(path)
    return log.is_file() and log.stat().st_size > 0


def _is_at_rest(path: Path) -> bool:
    """
    Tell whether a file has a write-ahead log by its head, but none lies beside it.

    SQLite would make one there, which only a folder that may be written takes; and leave it.
    """
    try:
        with path.open('rb') as file:
            head = file.read(_READ_VERSION_AT + 1)
    except OSError as error:
        raise BagError(f"'{path}' cannot be read: {error.strerror}") from None
    if not head:
        raise BagError(f"'{path}' is empty, as where its recording was killed at once")
    if not head.startswith(_MAGIC):
        raise BagError(f"'{path}' cannot be read as sqlite3: it does not begin as such files do")
    return head[-1] == _WAL_VERSION and not has_log(path)


@contextmanager
def in_words(path: Path) -> Iterator[None]:
    """Make a BagError of whatever reading a file raises."""
    try:
        yield
    except (sqlite3.Error, sqlite3.Warning, ValueError, OverflowError, MemoryError) as error:
        raise BagError(f"'{path}' cannot be read as sqlite3: {_why(path, error)}") from None


def _why(path: Path, error: Exception) -> str:
    text = ' '.join(str(error).split()) or 'it does not fit into memory'
    if 'locked' in text:
        return 'another program writes it at the moment; try again when that has ended'
    if 'malformed' in text or 'not a database' in text:
        return f'it is damaged ({text}): `sqlite3 OLD .recover | sqlite3 NEW` saves what is left'
    if 'unable to open' in text or 'readonly' in text or 'read-only' in text:
        for ending in ('-journal', '-wal'):
            beside = path.with_name(path.name + ending)
            if beside.exists():
                return _BESIDE.format(beside=beside)
    return text


class Tables:
    """
    The tables of a database with their columns.

    Views, virtual tables and columns that are worked out are left out: in the file of an enemy
    they could stand for anything, and last for ever.
    """

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection
        self._columns: dict[str, set[str]] = {}
        query = "SELECT name FROM sqlite_master WHERE type = 'table' AND rootpage > 0"
        for (name,) in connection.execute(query).fetchall():
            rows = connection.execute('SELECT name FROM pragma_table_info(?)', (name,))
            self._columns[name.lower()] = {column.lower() for (column,) in rows}

    def has(self, table: str, columns: Collection[str]) -> bool:
        return self._columns.get(table, set()).issuperset(columns)

    def require(self, table: str, columns: Collection[str]) -> None:
        """
        Refuse a database without a table and columns of it.

        :raises ValueError: they are not there.
        """
        if table not in self._columns:
            raise ValueError(f"it is no bag: it has no table '{table}'")
        lacking = sorted(set(columns) - self._columns[table])
        if lacking:
            raise ValueError(f"it is no bag: its table '{table}' has no '{lacking[0]}'")

    def has_index(self, table: str, column: str) -> bool:
        """Whether an index of the whole table begins with a column."""
        query = (
            'SELECT i.name FROM pragma_index_list(?) AS l, pragma_index_info(l.name) AS i '
            'WHERE i.seqno = 0 AND NOT l.partial'
        )
        return (column,) in self._connection.execute(query, (table,)).fetchall()
