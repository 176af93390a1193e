# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read one sqlite3 file: what ROS 2 records up to Humble, and later where it is asked to.

Facts of rosbag2_storage_sqlite3: version 1 of its schema has the tables topics and messages, and
no index; version 2 adds topics.offered_qos_profiles and an index of times, version 3 the tables
schema and metadata, version 4 the table message_definitions and topics.type_description_hash.
What is there is read, whatever version the file says.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import Any

from rosbag2_py import _qos
from rosbag2_py._metadata import BagMetadata, MessageDefinition, TopicInformation, TopicMetadata
from rosbag2_py._metadata_io import MetadataIo
from rosbag2_py._options import ReadOrder, ReadOrderSortBy
from rosbag2_py.errors import BagError
from rosbag2_py.storages.interface import Contents, Span, Start, StoredFile, StoredMessage
from rosbag2_py.storages.sqlite_database import has_log, in_words, log_of, opened, Tables

_PAGE = 1000
"""So many places are read at once; between them who writes the file need not wait."""
_MOST_TOPICS = 2**16 - 1
_TOPIC = ('id', 'name', 'type', 'serialization_format')
_TOPIC_TEXTS = (*_TOPIC[1:], 'offered_qos_profiles', 'type_description_hash')
_DEFINITION = ('topic_type', 'encoding', 'encoded_message_definition', 'type_description_hash')


class SqliteFile(StoredFile):
    """A file that is read by its index of times, a message at a time."""

    def __init__(self, path: Path) -> None:
        self.path = path
        if has_log(path):
            log = log_of(path).name
            self.caution = f"needs '{log}' beside it: its recording was killed, or goes on"
        self._connection = opened(path)
        try:
            with in_words(path):
                self._tables = Tables(self._connection)
                self._tables.require('topics', _TOPIC)
                self._tables.require('messages', ('id', 'topic_id', 'timestamp', 'data'))
                self._topics = self._read_topics()
        except BaseException:
            self._connection.close()
            raise

    def close(self) -> None:
        self._connection.close()

    @cached_property
    def contents(self) -> Contents:
        """What it holds; messages whose topic the file does not have are not counted."""
        spans = {number: Span() for number in self._topics}
        with in_words(self.path):
            for topic, *span in self._connection.execute(
                'SELECT topic_id, MIN(timestamp), MAX(timestamp), COUNT(*) FROM messages '
                'GROUP BY topic_id'
            ):
                if topic in spans:
                    spans[topic] = Span(*map(_time, span))
            told = self._told()
            (pages,) = self._connection.execute('PRAGMA page_count').fetchone()
            (page_bytes,) = self._connection.execute('PRAGMA page_size').fetchone()
        whole = Span()
        for each in spans.values():
            whole.extend(each)
        topics = [TopicInformation(t, spans[number].count) for number, t in self._topics.items()]
        return Contents(topics, whole, told, pages * page_bytes)

    def definitions(self) -> list[MessageDefinition]:
        """Return those that it has: files from before version 4 have none."""
        if not self._tables.has('message_definitions', _DEFINITION):
            return []
        with in_words(self.path):
            rows = self._connection.execute(
                f'SELECT {", ".join(_DEFINITION)} FROM message_definitions ORDER BY id'
            )
            return [MessageDefinition(*map(_text, row)) for row in rows]

    def why_not(self, order: ReadOrder) -> str:
        if order.sort_by != ReadOrderSortBy.ReceivedTimestamp:
            return 'sqlite3 files can be read by ReadOrderSortBy.ReceivedTimestamp alone'
        return ''

    def messages(
        self, start: Start, order: ReadOrder, wanted: Callable[[str], bool]
    ) -> Iterator[StoredMessage]:
        names = {number: each.name for number, each in self._topics.items() if wanted(each.name)}
        with in_words(self.path):
            for time_ns, number, topic in self._places(start, order, list(names)):
                data = self._data(number)
                if data is not None:
                    key = (_time(time_ns), number)
                    yield StoredMessage(key, names[topic], data, time_ns, time_ns)

    def _places(
        self, start: Start, order: ReadOrder, topics: list[int]
    ) -> Iterator[tuple[int, int, int]]:
        """Yield the time, the number and the topic of messages in their order."""
        sign, direction = ('<', 'DESC') if order.reverse else ('>', 'ASC')
        query = (
            'SELECT timestamp, rowid, topic_id FROM messages '
            f'WHERE topic_id IN ({", ".join(map(str, topics))}) AND timestamp {sign}= ? '
            f'AND (timestamp {sign} ? OR rowid {sign} ?) '
            f'ORDER BY timestamp {direction}, rowid {direction} LIMIT ?'
        )
        # Without an index all places are sorted for each query, so there is only one.
        page = _PAGE if self._tables.has_index('messages', 'timestamp') else -1
        before_all = 2**63 - 1 if order.reverse else -(2**63)
        time_ns, number = start.after or (start.time_ns, before_all)
        while True:
            found = 0
            rows = self._connection.execute(query, (time_ns, time_ns, number, page))
            for time_ns, number, topic in rows.fetchall() if page > 0 else rows:
                found += 1
                yield time_ns, number, topic
            if found != page:
                return

    def _data(self, number: int) -> bytes | None:
        """Return the bytes of a message, or nothing where it was removed meanwhile."""
        query = 'SELECT data FROM messages WHERE rowid = ?'
        row = self._connection.execute(query, (number,)).fetchone()
        if row is None:
            return None
        if not isinstance(row[0], bytes):
            raise ValueError(f'message {number} has {type(row[0]).__name__} for data, not bytes')
        return row[0]

    def _read_topics(self) -> dict[int, TopicMetadata]:
        texts = [name for name in _TOPIC_TEXTS if self._tables.has('topics', [name])]
        query = f'SELECT id, {", ".join(texts)} FROM topics ORDER BY id'
        found: dict[int, TopicMetadata] = {}
        for number, *values in self._connection.execute(query):
            if not isinstance(number, int) or len(found) == _MOST_TOPICS:
                raise ValueError(f'topic {number!r} is no whole number, or one too many')
            told = dict(zip(texts, map(_text, values), strict=True))
            found[number] = TopicMetadata(
                len(found) + 1,
                told['name'],
                told['type'],
                told['serialization_format'],
                _qos.profiles_or_none(told.get('offered_qos_profiles', '')),
                told.get('type_description_hash', ''),
            )
        return found

    def _told(self) -> BagMetadata:
        bag = BagMetadata()
        if self._tables.has('metadata', ['id', 'metadata']):
            query = 'SELECT metadata FROM metadata ORDER BY id DESC LIMIT 1'
            for (text,) in self._connection.execute(query):
                with suppress(BagError):
                    bag = MetadataIo().deserialize_metadata(_text(text))
        if self._tables.has('schema', ['ros_distro']):
            for (distro,) in self._connection.execute('SELECT ros_distro FROM schema LIMIT 1'):
                bag.ros_distro = _text(distro)
        return bag


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f'{value!r:.50} stands where a text belongs')
    return value


def _time(value: Any) -> int:
    if not isinstance(value, int) or value < 0:
        raise ValueError(f'{value!r:.50} stands where a time in nanoseconds belongs')
    return value
