# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read one MCAP file, also one whose recording was killed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import suppress
import heapq
from pathlib import Path
from typing import Any, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.records import (
    Channel,
    Chunk,
    ChunkIndex,
    Footer,
    McapRecord,
    Message,
    Metadata,
    Schema,
    Statistics,
)
from mcap.stream_reader import breakup_chunk, StreamReader
from mcap.summary import Summary

from rosbag2_py import _qos
from rosbag2_py._metadata import BagMetadata, MessageDefinition, TopicInformation, TopicMetadata
from rosbag2_py._metadata_io import MetadataIo
from rosbag2_py._options import ReadOrder, ReadOrderSortBy
from rosbag2_py.errors import BagError
from rosbag2_py.storages.interface import Contents, Key, Span, Start, StoredFile, StoredMessage

_RECORD_HEAD = 9
_CHUNK_HEAD = 40
_END_OF_TIME_NS = 2**63  # of ROS; that of MCAP is twice as far
_FIRST = float('-inf')


class _Records(NamedTuple):
    summary: Summary
    statistics: Statistics
    rosbag2_record: dict[str, str]
    is_whole: bool


class McapFile(StoredFile):
    """A file whose contents are counted from itself where its end is missing."""

    seek_goes_on = True

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self._stream = path.open('rb')
        except OSError as error:
            raise BagError(f"'{path}' cannot be read: {error.strerror}") from None
        try:
            records = self._read_records()
        except BaseException:
            self._stream.close()
            raise
        self._summary, self._statistics, self._rosbag2_record, is_whole = records
        if not is_whole:
            self.caution = 'has no end: its recording was killed; read as far as it goes'
        # Messages can be read by time where their chunks are known.
        self.has_index = bool(self._summary.chunk_indexes or not self._statistics.message_count)

    def close(self) -> None:
        self._stream.close()

    @property
    def contents(self) -> Contents:
        of = self._statistics
        span = Span(of.message_start_time, of.message_end_time, of.message_count)
        return Contents(self._topics(), span, self._told(), self.path.stat().st_size)

    def definitions(self) -> list[MessageDefinition]:
        return [
            MessageDefinition(each.name, each.encoding, each.data.decode(errors='replace'), '')
            for each in self._summary.schemas.values()
        ]

    def why_not(self, order: ReadOrder) -> str:
        if order.sort_by == ReadOrderSortBy.PublishedTimestamp:
            return 'MCAP files cannot be read in the order in which messages were published'
        by_time = order.sort_by == ReadOrderSortBy.ReceivedTimestamp
        if order.reverse and not by_time:
            return 'MCAP files cannot be read backwards but by ReadOrderSortBy.ReceivedTimestamp'
        if by_time and not self.has_index:
            return f"'{self.path}' has no index: it is read in the order in which it was written"
        return ''

    def _topics(self) -> list[TopicInformation]:
        counts = self._statistics.channel_message_counts
        found = []
        for channel in self._summary.channels.values():
            schema = self._summary.schemas.get(channel.schema_id)
            topic = TopicMetadata(
                channel.id,
                channel.topic,
                schema.name if schema else '',
                channel.message_encoding,
                _qos.profiles_or_none(channel.metadata.get('offered_qos_profiles', '')),
                channel.metadata.get('topic_type_hash', ''),
            )
            found.append(TopicInformation(topic, counts.get(channel.id, 0)))
        return found

    def _told(self) -> BagMetadata:
        told = self._rosbag2_record
        bag = BagMetadata()
        with suppress(KeyError, BagError):
            bag = MetadataIo().deserialize_metadata(told['serialized_metadata'])
        bag.ros_distro = told.get('ROS_DISTRO', bag.ros_distro)
        return bag

    def messages(
        self, start: Start, order: ReadOrder, wanted: Callable[[str], bool]
    ) -> Iterator[StoredMessage]:
        topics = {n: c.topic for n, c in self._summary.channels.items() if wanted(c.topic)}
        try:
            if not self._summary.chunk_indexes:
                yield from self._unindexed(start, topics)
            elif order.sort_by == ReadOrderSortBy.File:
                yield from self._in_file_order(start, topics)
            else:
                yield from self._by_time(start, topics, -1 if order.reverse else 1)
        except Exception as error:  # of damaged bytes the libraries raise many types
            raise _unreadable(self.path, error) from None

    def _by_time(self, start: Start, topics: dict[int, str], sign: int) -> Iterator[StoredMessage]:
        """Merge the chunks, each of which is read when the first of its messages is due."""
        heap: list[tuple[int, int, float, Any]] = []
        for chunk in self._chunks(topics):
            first = chunk.message_start_time if sign > 0 else chunk.message_end_time
            last = chunk.message_end_time if sign > 0 else chunk.message_start_time
            if sign * last >= sign * start.time_ns:
                heap.append((sign * first, sign * chunk.chunk_start_offset, _FIRST, chunk))
        heapq.heapify(heap)
        after = None if start.after is None else tuple(sign * each for each in start.after)
        while heap:
            _, offset, _, item = heapq.heappop(heap)
            if not isinstance(item, ChunkIndex):
                yield item
                continue
            for index, message in self._of_chunk(item, topics):
                place = (sign * message.log_time, offset, sign * index)
                if place[0] >= sign * start.time_ns and (after is None or place > after):
                    key = (message.log_time, item.chunk_start_offset, index)
                    heapq.heappush(heap, (*place, _stored(key, message, topics)))

    def _in_file_order(self, start: Start, topics: dict[int, str]) -> Iterator[StoredMessage]:
        for chunk in sorted(self._chunks(topics), key=lambda each: each.chunk_start_offset):
            for index, message in self._of_chunk(chunk, topics):
                key = (chunk.chunk_start_offset, index)
                if message.log_time >= start.time_ns and (not start.after or key > start.after):
                    yield _stored(key, message, topics)

    def _unindexed(self, start: Start, topics: dict[int, str]) -> Iterator[StoredMessage]:
        for index, record in enumerate(self._records()):
            if isinstance(record, Message) and record.channel_id in topics:
                key = (0, index)
                if record.log_time >= start.time_ns and (not start.after or key > start.after):
                    yield _stored(key, record, topics)

    def _chunks(self, topics: dict[int, str]) -> Iterator[ChunkIndex]:
        for chunk in self._summary.chunk_indexes:
            channels = chunk.message_index_offsets
            if not channels or not topics.keys().isdisjoint(channels):
                yield chunk

    def _of_chunk(self, chunk: ChunkIndex, topics: dict[int, str]) -> list[tuple[int, Message]]:
        self._stream.seek(chunk.chunk_start_offset + _RECORD_HEAD)
        records = breakup_chunk(Chunk.read(ReadDataStream(self._stream)))
        return [
            (index, record)
            for index, record in enumerate(records)
            if isinstance(record, Message) and record.channel_id in topics
        ]

    def _records(self, *, emit_chunks: bool = False) -> Iterator[McapRecord]:
        """Yield the records from the first to the last that is whole."""
        self._stream.seek(0)
        try:
            yield from StreamReader(self._stream, emit_chunks=emit_chunks).records
        except EndOfFile:
            return

    def _read_records(self) -> _Records:
        try:
            reader = make_reader(self._stream)
        except Exception as error:  # as above
            raise _unreadable(self.path, error) from None
        try:
            summary = reader.get_summary()
            statistics = summary.statistics if summary else None
            if summary and statistics and _names_all(summary, statistics):
                told = [each.metadata for each in reader.iter_metadata() if each.name == 'rosbag2']
                return _Records(summary, statistics, told[-1] if told else {}, True)
        except Exception:  # noqa: S110
            pass  # It has no end, or a damaged one; the rest may be whole.
        try:
            return self._scan()
        except Exception as error:  # as above
            raise _unreadable(self.path, error) from None

    def _scan(self) -> _Records:
        """Tell the contents from what the file has, up to where it ends."""
        summary, told = Summary(), {}
        seen: list[int] = []
        counts: dict[int, int] = defaultdict(int)
        is_whole = False
        for record in self._records(emit_chunks=True):
            inside = [record]
            is_whole = isinstance(record, Footer)
            if isinstance(record, Chunk):
                inside = breakup_chunk(record)
                channels = {each.channel_id for each in inside if isinstance(each, Message)}
                end = self._stream.tell()
                summary.chunk_indexes.append(_index(record, end, channels))
            if isinstance(record, Metadata) and record.name == 'rosbag2':
                told = record.metadata
            for each in inside:
                if isinstance(each, Schema):
                    summary.schemas[each.id] = each
                elif isinstance(each, Channel):
                    summary.channels[each.id] = each
                elif isinstance(each, Message):
                    counts[each.channel_id] += 1
                    seen = [min([each.log_time, *seen]), max([each.log_time, *seen])]
        first, last = seen or (0, 0)
        statistics = Statistics(
            attachment_count=0,
            channel_count=len(summary.channels),
            channel_message_counts=counts,
            chunk_count=len(summary.chunk_indexes),
            message_count=sum(counts.values()),
            metadata_count=0,
            message_start_time=first,
            message_end_time=last,
            schema_count=len(summary.schemas),
        )
        return _Records(summary, statistics, told, is_whole)


def _names_all(summary: Summary, statistics: Statistics) -> bool:
    """Return whether a summary has every channel and its type; a writer may leave them out."""
    used = {channel.schema_id for channel in summary.channels.values()} - {0}
    return len(summary.channels) == statistics.channel_count and used <= summary.schemas.keys()


def _stored(key: Key, message: Message, topics: dict[int, str]) -> StoredMessage:
    topic = topics[message.channel_id]
    if message.log_time >= _END_OF_TIME_NS:
        raise ValueError(f"a message of '{topic}' is of after the year 2262: it is damaged")
    return StoredMessage(key, topic, message.data, message.log_time, message.publish_time)


def _index(chunk: Chunk, end: int, channels: set[int]) -> ChunkIndex:
    """Return the index of a chunk that ends at a place of the file."""
    length = _RECORD_HEAD + _CHUNK_HEAD + len(chunk.compression.encode()) + len(chunk.data)
    return ChunkIndex(
        chunk_length=length,
        chunk_start_offset=end - length,
        compression=chunk.compression,
        compressed_size=len(chunk.data),
        message_end_time=chunk.message_end_time,
        message_index_length=0,
        message_index_offsets=dict.fromkeys(channels, 0),
        message_start_time=chunk.message_start_time,
        uncompressed_size=chunk.uncompressed_size,
    )


def _unreadable(file: Path, error: Exception) -> BagError:
    why = str(error)
    if isinstance(error, EndOfFile):
        why = 'it ends too soon, as where its recording was killed'
    elif isinstance(error, KeyError):
        why = f'{type(error).__name__}: {error}'
    return BagError(f"'{file}' cannot be read as MCAP: {why}")
