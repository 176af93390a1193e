# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write one sqlite3 file, with the tables of a real Jazzy (version 4 of its schema)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
import sqlite3
from typing import Any

from rosbag2_py import _qos
from rosbag2_py._log import warn
from rosbag2_py._metadata import BagMetadata, MessageDefinition, TopicMetadata
from rosbag2_py._metadata_io import dump, MetadataIo
from rosbag2_py.errors import BagError
from rosbag2_py.storages.interface import FileWriter, ROS_DISTRO

_SCHEMA_VERSION = 4
_TABLES = {
    'schema': 'schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL',
    'metadata': 'id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, '
    'metadata TEXT NOT NULL',
    'topics': 'id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, '
    'serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, '
    'type_description_hash TEXT NOT NULL',
    'message_definitions': 'id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, '
    'encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, '
    'type_description_hash TEXT NOT NULL',
    'messages': 'id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, '
    'timestamp INTEGER NOT NULL, data BLOB NOT NULL',
}
_MOST_WAITING = 1024 * 1024
"""After so many bytes they are committed; a program that is killed loses no more."""
_BUSY_SEC = 0.5
_ROW_BYTES = 24
"""What a message takes beside its bytes."""


class SqliteWriter(FileWriter):
    """
    Writes by a write-ahead log, which is taken into the file and removed at its end.

    Upstream keeps its journal in memory instead, so that a file is lost where its recording was
    killed at the wrong moment. With the preset 'resilient' it also stands where power fails.
    """

    def __init__(self, path: Path, preset: str) -> None:
        self._path = path
        self._topics: dict[str, int] = {}
        self._topic_count = 0  # also of those removed, whose numbers SQLite would give again
        self._types: set[str] = set()
        self._waiting = 0
        self._is_open = True
        # BagWriter is made in one thread and used in another.
        self._connection = sqlite3.connect(
            path.absolute(), timeout=_BUSY_SEC, isolation_level=None, check_same_thread=False
        )
        try:
            with self._in_words():
                self._begin(preset)
        except BaseException:
            self._connection.close()
            raise

    @property
    def size(self) -> int:
        return self._committed_bytes + self._waiting

    def add_topic(self, topic: TopicMetadata, definition: MessageDefinition) -> None:
        qos = dump(_qos.to_dicts(topic.offered_qos_profiles))
        type_hash = topic.type_description_hash
        self._topic_count += 1
        with self._in_words():
            self._execute(
                'INSERT INTO topics VALUES (?, ?, ?, ?, ?, ?)',
                self._topic_count,
                topic.name,
                topic.type,
                topic.serialization_format,
                qos,
                type_hash,
            )
            self._topics[topic.name] = self._topic_count
            if definition.topic_type not in self._types:
                self._types.add(definition.topic_type)
                text = definition.encoded_message_definition
                type_hash = definition.type_hash or type_hash
                self._insert(
                    'message_definitions',
                    definition.topic_type,
                    definition.encoding,
                    text,
                    type_hash,
                )

    def remove_topic(self, name: str) -> None:
        """Remove it from the topics, so that its messages are not read any more."""
        with self._in_words():
            self._execute('DELETE FROM topics WHERE id = ?', self._topics.pop(name))

    def write(
        self, topic_name: str, data: bytes, received_ns: int, published_ns: int, number: int
    ) -> None:
        """Write a message; such files have no place for when it was published."""
        del published_ns, number
        try:
            if not self._connection.in_transaction:
                self._connection.execute('BEGIN')
            self._connection.execute(
                'INSERT INTO messages (timestamp, topic_id, data) VALUES (?, ?, ?)',
                (received_ns, self._topics[topic_name], data),
            )
        except (sqlite3.DataError, OverflowError) as error:  # as upstream: the others are kept
            warn(f"A message of '{topic_name}' is left out: {error} ({len(data)} bytes)")
        except sqlite3.Error as error:
            raise self._unwritable(error) from None
        self._waiting += len(data) + _ROW_BYTES
        if self._waiting >= _MOST_WAITING:
            self.flush()

    def flush(self) -> None:
        """Commit what was written, which is what others can read, and what outlives a kill."""
        if self._is_open and self._connection.in_transaction:
            with self._in_words():
                self._connection.execute('COMMIT')
                self._count_pages()

    def finish(self, metadata: BagMetadata) -> None:
        if not self._is_open:
            return
        try:
            self.flush()
            with self._in_words():
                told = MetadataIo().serialize_metadata(metadata)
                self._insert('metadata', metadata.version, told)
            # Where somebody reads the file just now, the log stays beside it.
            with suppress(sqlite3.OperationalError):
                self._execute('PRAGMA journal_mode = DELETE')
        finally:
            self._is_open = False
            self._connection.close()

    def _begin(self, preset: str) -> None:
        self._execute('PRAGMA journal_mode = WAL')
        self._execute(f'PRAGMA synchronous = {"NORMAL" if preset == "resilient" else "OFF"}')
        self._execute('BEGIN')
        for name, columns in _TABLES.items():
            self._execute(f'CREATE TABLE {name}({columns})')
        self._execute('CREATE INDEX timestamp_idx ON messages (timestamp ASC)')
        self._execute('INSERT INTO schema VALUES (?, ?)', _SCHEMA_VERSION, ROS_DISTRO)
        self._execute('COMMIT')
        self._count_pages()

    def _insert(self, table: str, *row: Any) -> None:
        marks = ', '.join('?' * len(row))
        self._execute(f'INSERT INTO {table} VALUES (NULL, {marks})', *row)

    def _execute(self, query: str, *values: Any) -> None:
        self._connection.execute(query, values).close()

    def _count_pages(self) -> None:
        (pages,) = self._connection.execute('PRAGMA page_count').fetchone()
        (page_bytes,) = self._connection.execute('PRAGMA page_size').fetchone()
        self._committed_bytes: int = pages * page_bytes
        self._waiting = 0

    @contextmanager
    def _in_words(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise self._unwritable(error) from None

    def _unwritable(self, error: Exception) -> BagError:
        return BagError(f"'{self._path}' cannot be written: {error}")
