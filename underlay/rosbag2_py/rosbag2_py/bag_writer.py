# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write a bag."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, ExitStack
from dataclasses import dataclass
from pathlib import Path
import shutil

from rosbag2_py import _qos, compression
from rosbag2_py._compression_options import CompressionMode, FORMATS
from rosbag2_py._message_definitions import definition_or_empty
from rosbag2_py._metadata import (
    BagMetadata,
    FileInformation,
    MessageDefinition,
    TopicInformation,
    TopicMetadata,
)
from rosbag2_py._metadata_io import MetadataIo
from rosbag2_py.errors import BagError
from rosbag2_py.storages.interface import ROS_DISTRO, Span, Storage

# What rosbag2 writes for a duration without end.
_FOREVER = {'sec': 9223372036, 'nsec': 854775807}


@dataclass
class Limits:
    """When a new file is begun: after so many bytes or seconds; 0 for never."""

    file_bytes: int = 0
    file_sec: int = 0


@dataclass
class _File:
    path: Path
    span: Span


@dataclass
class _Topic:
    metadata: TopicMetadata
    definition: MessageDefinition
    count: int = 0


def already_there(folder: Path | str) -> BagError:
    return BagError(
        f"Output folder '{folder}' already exists, and no bag is written over: choose another "
        'name, or remove it'
    )


def offered_qos(*, reliable: bool, transient_local: bool) -> _qos.QoS:
    """Return what a publisher offers, with limits of time that it does not have."""
    return _qos.from_dicts(
        [
            {
                'history': 'keep_last',
                'depth': 10,
                'reliability': 'reliable' if reliable else 'best_effort',
                'durability': 'transient_local' if transient_local else 'volatile',
                'deadline': _FOREVER,
                'lifespan': _FOREVER,
                'liveliness': 'automatic',
                'liveliness_lease_duration': _FOREVER,
                'avoid_ros_namespace_conventions': False,
            }
        ]
    )[0]


class BagWriter:
    """
    A bag that is being written; close it, or use it as a context manager.

    It is not for several threads, and what is interrupted within a call is not whole.

    :param compress: messages are compressed as they come, files in another thread.
    :ivar on_split: is told of a file that is complete, and compressed, and of the one that follows
        it; in that thread where files are compressed.
    :raises BagError: the folder exists or cannot be made; every method: the disk is full.
    """

    def __init__(
        self,
        folder: Path,
        storage: Storage,
        *,
        preset: str = 'none',
        limits: Limits | None = None,
        compress: CompressionMode = CompressionMode.NONE,
        custom_data: dict[str, str] | None = None,
    ) -> None:
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            raise already_there(folder) from None
        except OSError as error:
            raise BagError(f"'{folder}' cannot be made: {error.strerror}") from None
        self.folder = folder
        self.on_split: Callable[[Path, Path], None] | None = None
        self._storage = storage
        self._preset = preset
        self._limits = limits or Limits()
        self._custom_data = custom_data or {}
        self._is_closed = False
        self._topics: dict[str, _Topic] = {}
        self._all = Span()
        self._files: list[_File] = []
        self._mode = compress
        of_messages = compress is CompressionMode.MESSAGE
        self._compress_message = compression.compressor() if of_messages else None
        self._pool = ThreadPoolExecutor(1) if compress is CompressionMode.FILE else None
        self._compressing: list[Future[None]] = []
        try:
            with self._refusals():
                self._begin_file()
        except BaseException:  # also Ctrl-C, while the storage loads: the name can be used again
            shutil.rmtree(folder, ignore_errors=True)
            raise

    def __enter__(self) -> BagWriter:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def file(self) -> Path:
        """The file that is being written."""
        return self._files[-1].path

    @property
    def message_count(self) -> int:
        return self._all.count

    def add_topic(
        self, metadata: TopicMetadata, definition: MessageDefinition | None = None
    ) -> None:
        """
        Add a topic before its first message.

        :param definition: that of its type; looked up where none is given, and empty where there
            is none.
        """
        if definition is None:
            definition = definition_or_empty(metadata.type)
        self._topics[metadata.name] = _Topic(metadata, definition)
        with self._refusals():
            self._file.add_topic(metadata, definition)

    def remove_topic(self, name: str) -> None:
        """Leave a topic out of metadata.yaml, and of the files as far as the storage can."""
        del self._topics[name]
        self._file.remove_topic(name)

    def has_topic(self, name: str) -> bool:
        return name in self._topics

    def write(self, topic_name: str, data: bytes, received_ns: int, published_ns: int) -> None:
        topic = self._topics[topic_name]
        if self._is_full(received_ns):
            self.split()
        if self._compress_message is not None:
            data = self._compress_message(data)
        try:
            self._file.write(topic_name, data, received_ns, published_ns, topic.count)
        except OSError as error:
            raise self._refusal(error) from None
        topic.count += 1
        self._all.add(received_ns)
        self._files[-1].span.add(received_ns)

    def flush(self) -> None:
        """Let other programs read what was written, as far as that is cheap."""
        with self._refusals():
            self._file.flush()

    def split(self) -> None:
        """Begin a new file."""
        closed = self._files[-1]
        with self._refusals():
            self._file.finish(self._metadata())
            for each in self._compressing:
                if each.done():
                    each.result()
            self._begin_file()
        self._complete(closed, self._files[-1])

    def close(self) -> None:
        """Finish the files; may be called twice."""
        if self._is_closed:
            return
        self._is_closed = True
        with self._refusals(), ExitStack() as later:
            self._file.finish(self._metadata())
            self._complete(self._files[-1], None)
            for each in self._compressing:
                later.callback(each.result)  # the bag is described also where that fails
            if self._pool is not None:
                self._pool.shutdown()
            MetadataIo().write_metadata(str(self.folder), self._metadata())

    def _complete(self, closed: _File, following: _File | None) -> None:
        """Compress a file that is complete, and tell of it."""

        def complete() -> None:
            if self._mode is CompressionMode.FILE:
                closed.path = compression.compress_file(closed.path)
            if self.on_split is not None and following is not None:
                self.on_split(closed.path, following.path)

        if self._pool is None:
            complete()
        else:
            self._compressing.append(self._pool.submit(complete))

    @contextmanager
    def _refusals(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise self._refusal(error) from None

    def _refusal(self, error: OSError) -> BagError:
        return BagError(f"'{self.folder}' cannot be written: {error.strerror or error}")

    def _is_full(self, time_ns: int) -> bool:
        span, limits = self._files[-1].span, self._limits
        if limits.file_bytes and self._file.size >= limits.file_bytes:
            return True
        return bool(
            limits.file_sec
            and span.count
            and time_ns - span.start_ns > limits.file_sec * 1_000_000_000
        )

    def _begin_file(self) -> None:
        stem = f'{self.folder.name or self.folder.resolve().name}_{len(self._files)}'
        path = self.folder / f'{stem}{self._storage.suffix}'
        self._file = self._storage.write(path, self._preset)
        self._files.append(_File(path, Span()))  # where the disk is full, the bag has none
        for topic in self._topics.values():
            self._file.add_topic(topic.metadata, topic.definition)

    def _metadata(self) -> BagMetadata:
        topics = self._topics.values()
        return BagMetadata(
            storage_identifier=self._storage.id,
            relative_file_paths=[file.path.name for file in self._files],
            files=[
                FileInformation(
                    file.path.name, file.span.start, file.span.duration, file.span.count
                )
                for file in self._files
            ],
            duration=self._all.duration,
            starting_time=self._all.start,
            message_count=sum(topic.count for topic in topics),
            topics_with_message_count=[
                TopicInformation(topic.metadata, topic.count) for topic in topics
            ],
            compression_format='' if self._mode is CompressionMode.NONE else FORMATS[0],
            compression_mode='' if self._mode is CompressionMode.NONE else self._mode.name,
            custom_data=self._custom_data,
            ros_distro=ROS_DISTRO,
        )
