# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write a bag from a program."""

from __future__ import annotations

import copy
from pathlib import Path
import threading
from typing import Any
import weakref

from rosbag2_py._compression_options import CompressionMode, CompressionOptions, FORMATS
from rosbag2_py._fields import check_kind, nanoseconds_of
from rosbag2_py._log import warn
from rosbag2_py._message_definitions import definition_or_empty
from rosbag2_py._metadata import MessageDefinition, TopicMetadata
from rosbag2_py._options import ConverterOptions, StorageOptions
from rosbag2_py._writing_thread import WritingThread
from rosbag2_py.bag_writer import BagWriter, Limits
from rosbag2_py.errors import BagError
from rosbag2_py.last_messages import LastMessages
from rosbag2_py.storages import DEFAULT_ID, storage_of, STORAGES
from rosbag2_py.storages.interface import Storage


class SequentialWriter:
    """
    Writes messages into a bag, from any thread.

    What has no `close` is closed when the writer is deleted, or the program ends.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._topics: dict[str, TopicMetadata] = {}
        self._compress = CompressionMode.NONE
        self._last: LastMessages | None = None
        self._close: weakref.finalize[..., SequentialWriter] | None = None

    def open(  # noqa: A003
        self, storage_options: StorageOptions, converter_options: ConverterOptions, /
    ) -> None:
        """
        Make the folder of the bag; a writer that is open already stays as it is.

        :raises BagError: the folder exists, or an option is not offered here, or makes no sense.
        """
        check_kind(storage_options, StorageOptions)
        check_kind(converter_options, ConverterOptions)
        with self._lock:
            if self._close is not None:
                return
            storage = storage_to_write(storage_options, converter_options)
            self._options = copy.copy(storage_options)
            self._writer = BagWriter(
                Path(storage_options.uri),
                storage,
                preset=storage_options.storage_preset_profile or 'none',
                limits=Limits(
                    storage_options.max_bagfile_size, storage_options.max_bagfile_duration
                ),
                compress=self._compress,
                custom_data=storage_options.custom_data,
            )
            self._last = None
            if storage_options.snapshot_mode:
                self._last = LastMessages(self._writer, storage_options.max_cache_size)
            self._thread = WritingThread(self._writer)
            self._topics = {}
            self._close = weakref.finalize(self, self._thread.close_at_exit)

    def close(self) -> None:
        """Finish the bag; may be called twice."""
        with self._lock:
            if self._close is None:
                return
            try:
                self._thread.close()
            finally:
                if self._thread.has_ended:  # Ctrl-C may have come before.
                    self._close.detach()
                    self._close = None

    def create_topic(self, topic_with_type: TopicMetadata, /) -> None:
        """Add a topic, before its first message; one of that name is left as it is."""
        check_kind(topic_with_type, TopicMetadata)
        self._create(topic_with_type, None)

    def _create(
        self, topic_with_type: TopicMetadata, definition: MessageDefinition | None
    ) -> None:
        with self._lock:
            self._check_open()
            if topic_with_type.name in self._topics:
                return
            definition = definition or definition_or_empty(topic_with_type.type)
            self._topics[topic_with_type.name] = topic_with_type
            self._thread.put(0, self._writer.add_topic, topic_with_type, definition)

    def remove_topic(self, topic_with_type: TopicMetadata, /) -> None:
        check_kind(topic_with_type, TopicMetadata)
        with self._lock:
            self._check_open()
            self._known(topic_with_type.name)
            del self._topics[topic_with_type.name]
            self._thread.put(0, self._writer.remove_topic, topic_with_type.name)

    def write(
        self,
        topic_name: str,
        message: bytes,
        recv_timestamp: int,
        send_timestamp: int | None = None,
        /,
    ) -> None:
        """
        Write a message, as rclpy.serialization.serialize_message gives it.

        :param recv_timestamp: nanoseconds since the epoch.
        :param send_timestamp: the same where none is given.
        :raises BagError: the bag is not open, or has no such topic, or the disk is full.
        """
        data = _bytes(message)
        received_ns = nanoseconds_of(recv_timestamp, first=0)
        sent_ns = received_ns
        if send_timestamp is not None:
            sent_ns = nanoseconds_of(send_timestamp, first=0)
        with self._lock:
            self._check_open()
            if received_ns < self._options.start_time_ns:
                return
            if 0 <= self._options.end_time_ns < received_ns:
                return
            self._known(topic_name)
            write = (self._last or self._writer).write
            self._thread.put(len(data), write, topic_name, data, received_ns, sent_ns)

    def split_bagfile(self) -> None:
        """Begin a new file."""
        with self._lock:
            self._check_open()
            self._thread.put(0, self._writer.split)

    def take_snapshot(self) -> bool:
        """Write the last messages; return False where the snapshot mode is off."""
        with self._lock:
            if self._last is None:
                warn('take_snapshot() writes nothing: StorageOptions has no snapshot_mode=True')
                return False
            self._check_open()
            self._thread.put(0, self._last.take)
            return True

    def _check_open(self) -> None:
        if self._close is None:
            raise BagError('The bag is not open: call open() first')

    def _known(self, topic_name: str) -> None:
        if topic_name not in self._topics:
            known = ', '.join(map(repr, self._topics)) or 'none'
            raise BagError(
                f'The bag has no topic {topic_name!r}, but {known}: call create_topic() before '
                'the first write()'
            )


class SequentialCompressionWriter(SequentialWriter):
    """Writes a bag whose files or messages are compressed."""

    def __init__(self, compression_options: CompressionOptions, /) -> None:
        """
        Compress as the options say.

        :raises BagError: they say that nothing is compressed, or name no format.
        """
        check_kind(compression_options, CompressionOptions)
        super().__init__()
        self._compress = compression_options.compression_mode
        if self._compress is CompressionMode.NONE:
            raise BagError(
                'SequentialCompressionWriter needs CompressionMode.FILE or CompressionMode.MESSAGE'
            )
        if compression_options.compression_format not in FORMATS:
            raise BagError(
                f"compression_format='{compression_options.compression_format}': here it is "
                f'{" or ".join(FORMATS)}'
            )


def add_topic(
    writer: SequentialWriter, topic: TopicMetadata, definition: MessageDefinition | None
) -> None:
    """Add a topic as `create_topic` does, with the definition of its type if one is known."""
    writer._create(topic, definition)


def get_registered_writers() -> set[str]:
    return set(STORAGES)


def get_registered_compressors() -> set[str]:
    return set(FORMATS)


def get_registered_serializers() -> set[str]:
    """Return none: what is written is serialized already."""
    return set()


def storage_to_write(options: StorageOptions, converter: ConverterOptions) -> Storage:
    """
    Return the storage for a new bag.

    :raises BagError: an option is not offered here.
    """
    storage = storage_of(options.storage_id or DEFAULT_ID)
    if options.storage_preset_profile not in ('', *storage.presets):
        raise BagError(
            f"storage_preset_profile='{options.storage_preset_profile}': for {storage.id} it is "
            f'one of {", ".join(storage.presets)}'
        )
    if options.storage_config_uri:
        raise BagError(
            f"storage_config_uri='{options.storage_config_uri}': files of settings are not read "
            'here; use storage_preset_profile'
        )
    if options.snapshot_mode and not options.max_cache_size:
        raise BagError(
            'snapshot_mode=True needs a max_cache_size: so many bytes of messages are kept'
        )
    if 0 < options.max_bagfile_size < storage.smallest_file_bytes:
        raise BagError(
            f'max_bagfile_size={options.max_bagfile_size}: it is {storage.smallest_file_bytes} '
            f'bytes at least for {storage.id}, or 0 for no limit'
        )
    given, kept = converter.input_serialization_format, converter.output_serialization_format
    if given != kept:
        raise BagError(
            f"ConverterOptions('{given}', '{kept}'): messages are not converted here; write "
            "ConverterOptions('', '')"
        )
    return storage


def _bytes(message: Any) -> bytes:
    if isinstance(message, bytes):
        return message
    if isinstance(message, bytearray | memoryview):
        return bytes(message)
    if isinstance(message, str):
        return message.encode()
    raise TypeError(
        f'write() takes the bytes of a message, not a {type(message).__name__}: '
        'rclpy.serialization.serialize_message(msg) makes them'
    )
