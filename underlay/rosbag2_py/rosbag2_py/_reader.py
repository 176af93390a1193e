# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read a bag in a program."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import copy
from pathlib import Path
import weakref

from rosbag2_py import bag_files, compression
from rosbag2_py._fields import check_kind, nanoseconds_of
from rosbag2_py._log import warn
from rosbag2_py._metadata import BagMetadata, MessageDefinition, TopicMetadata
from rosbag2_py._options import (
    ConverterOptions,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
)
from rosbag2_py.errors import BagError
from rosbag2_py.selection import wanted
from rosbag2_py.storages import STORAGES
from rosbag2_py.storages.interface import Key, Start, Storage, StoredFile, StoredMessage


class SequentialReader:
    """Reads the messages of a bag one after another, file by file."""

    def __init__(self) -> None:
        self._storage: Storage
        self._files: list[Path] = []
        self._metadata = BagMetadata()
        self._filter = StorageFilter()
        self._order = ReadOrder()
        self._sought_ns = 0
        self._file: StoredFile | None = None
        self._number = 0
        self._close: Callable[[], object] = _nothing
        self._on_split: Callable[[Path, Path], object] | None = None
        # The place: a time, and the message of it that was read last.
        self._time_ns = 0
        self._key: Key | None = None
        self._messages: Iterator[StoredMessage] = iter(())
        self._next: StoredMessage | None = None

    def open_uri(self, uri: str, /) -> None:
        self.open(StorageOptions(uri), ConverterOptions())

    def open(  # noqa: A003
        self, storage_options: StorageOptions, converter_options: ConverterOptions, /
    ) -> None:
        """
        Open a bag, or one of its files alone, before its first message.

        :raises BagError: there is none, or it is stored in another way, or it is damaged.
        """
        check_kind(storage_options, StorageOptions)
        check_kind(converter_options, ConverterOptions)
        path = Path(storage_options.uri)
        storage, files = bag_files.find(path, storage_options.storage_id)
        metadata = bag_files.read_metadata(path, storage.id)
        _check_formats(metadata, converter_options.output_serialization_format)
        self._storage, self._files, self._metadata = storage, files, metadata
        self._load(0)

    def set_read_order(self, order: ReadOrder, /) -> bool:
        """Choose the order; return whether the storage can read in it."""
        check_kind(order, ReadOrder)
        file = self._opened()
        if reason := file.why_not(order):
            warn(reason)
            return False
        if order.sort_by != self._order.sort_by:
            self._key = None  # Places are other ones there.
        self._order = ReadOrder(order.sort_by, order.reverse)
        self._restart()
        return True

    def has_next(self) -> bool:
        """Return whether there is a message to read, in this file or one to come."""
        self._opened()
        while self._next is None:
            self._next = next(self._messages, None)
            if self._next is None:
                following = self._number + (-1 if self._order.reverse else 1)
                if not 0 <= following < len(self._files):
                    return False
                self._load(following)
        return True

    def read_next(self) -> tuple[str, bytes, int]:
        """
        Return the topic of the next message, its bytes and its time in nanoseconds.

        :raises BagError: there is none.
        """
        message = self._take()
        return message.topic, message.data, message.time_ns

    def get_metadata(self) -> BagMetadata:
        self._opened()
        return self._metadata

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        self._opened()
        return [each.topic_metadata for each in self._metadata.topics_with_message_count]

    def get_all_message_definitions(self) -> list[MessageDefinition]:
        """Return the definitions that the file has which is read now."""
        return self._opened().definitions()

    def set_filter(self, storage_filter: StorageFilter, /) -> None:
        """Read some topics only, from the place where the reader is."""
        check_kind(storage_filter, StorageFilter)
        self._opened()
        wanted(storage_filter)  # refuses what is no expression, before anything changes
        self._filter = copy.copy(storage_filter)
        self._restart()

    def reset_filter(self) -> None:
        """Read all topics, from the place where the reader is."""
        self.set_filter(StorageFilter())

    def seek(self, timestamp: int, /) -> None:
        """
        Go to the first message of a time or after, or before where the order is reverse.

        As upstream, to the time of the message that was read last goes behind that message in
        MCAP files, and before the first of that time in others.
        """
        file = self._opened()
        timestamp = self._sought_ns = nanoseconds_of(timestamp)
        # First back, then on: a time between two files would lead to and fro.
        while self._number > 0 and file.contents.span.begins_after(timestamp):
            file = self._load(self._number - 1)
        while self._number + 1 < len(self._files) and timestamp > file.contents.span.end_ns:
            file = self._load(self._number + 1)
        if not (file.seek_goes_on and self._is_by_time and timestamp == self._time_ns):
            self._key = None
        self._time_ns = timestamp
        self._restart()

    def _take(self) -> StoredMessage:
        if not self.has_next() or self._next is None:
            raise BagError('The bag has no further message: ask has_next() before read_next()')
        message, self._next = self._next, None
        is_compressed = self._metadata.compression_mode.lower() == 'message'
        # a recording that was killed has no metadata that says so
        if is_compressed or message.data.startswith(compression.MAGIC):
            data = compression.decompressed(message.data, self._opened().path)
            message = message._replace(data=data)
        self._key = message.key
        if self._is_by_time:
            self._time_ns = message.time_ns
        return message

    def _opened(self) -> StoredFile:
        if self._file is None:
            raise BagError('The bag is not open: call open() first')
        return self._file

    def _load(self, number: int) -> StoredFile:
        """Open a file of the bag in place of the one before."""
        before, file = self._file, compression.read(self._storage, self._files[number])
        self._close()
        self._file, self._number = file, number
        self._close = weakref.finalize(self, file.close)
        if file.caution:
            warn(f"'{file.path}' {file.caution}")
        self._time_ns = self._sought_ns
        self._key = None
        self._restart()
        if before is not None and self._on_split is not None:
            self._on_split(before.path, file.path)
        return file

    @property
    def _is_by_time(self) -> bool:
        return self._order.sort_by != ReadOrderSortBy.File and self._opened().has_index

    def _restart(self) -> None:
        """Find the place again, after what may be read or how has changed."""
        self._next = None
        self._messages = self._opened().messages(
            Start(self._time_ns, self._key), self._order, wanted(self._filter)
        )


SequentialCompressionReader = SequentialReader  # it reads what is compressed, and what is not


def _nothing() -> None:
    """Stand for the closing of a file where there is none."""


def on_split(reader: SequentialReader, tell: Callable[[Path, Path], object]) -> None:
    """Have it told from now on which file was left, and which is read in its place."""
    reader._on_split = tell


def stored_messages(reader: SequentialReader) -> Iterator[StoredMessage]:
    """Yield what there is to read, with what `read_next` does not tell."""
    while reader.has_next():
        yield reader._take()


def get_registered_readers() -> set[str]:
    return set(STORAGES)


def _check_formats(metadata: BagMetadata, asked: str) -> None:
    """Refuse what would have to be converted; there are no converters here."""
    topics = [each.topic_metadata for each in metadata.topics_with_message_count]
    formats = {each.serialization_format for each in topics}
    if len(formats) > 1:
        raise BagError(f'The topics have several serialization formats: {sorted(formats)}')
    if formats and asked not in ('', *formats):
        raise BagError(
            f"output_serialization_format='{asked}': the bag has '{formats.pop()}', and nothing "
            "is converted here; write ConverterOptions('', '')"
        )
