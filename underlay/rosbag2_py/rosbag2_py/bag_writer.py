# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write a bag."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from rosbag2_py import _qos
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

    :ivar on_split: is told of a file that is complete, and of the one that follows it.
    :raises BagError: the folder exists or cannot be made; every method: the disk is full.
    """

    def __init__(
        self,
        folder: Path,
        storage: Storage,
        *,
        preset: str = 'none',
        limits: Limits | None = None,
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
        self._files: list[tuple[str, Span]] = []
        with self._refusals():
            self._begin_file()

    def __enter__(self) -> BagWriter:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def file(self) -> Path:
        """The file that is being written."""
        return self.folder / self._files[-1][0]

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
        try:
            self._file.write(topic_name, data, received_ns, published_ns, topic.count)
        except OSError as error:
            raise self._refusal(error) from None
        topic.count += 1
        self._all.add(received_ns)
        self._files[-1][1].add(received_ns)

    def flush(self) -> None:
        """Let other programs read what was written, as far as that is cheap."""
        with self._refusals():
            self._file.flush()

    def split(self) -> None:
        """Begin a new file."""
        closed = self.file
        with self._refusals():
            self._file.finish(self._metadata())
            self._begin_file()
        if self.on_split is not None:
            self.on_split(closed, self.file)

    def close(self) -> None:
        """Finish the files; may be called twice."""
        if self._is_closed:
            return
        self._is_closed = True
        with self._refusals():
            self._file.finish(self._metadata())
            MetadataIo().write_metadata(str(self.folder), self._metadata())

    @contextmanager
    def _refusals(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise self._refusal(error) from None

    def _refusal(self, error: OSError) -> BagError:
        return BagError(f"'{self.folder}' cannot be written: {error.strerror or error}")

    def _is_full(self, time_ns: int) -> bool:
        span, limits = self._files[-1][1], self._limits
        if limits.file_bytes and self._file.size >= limits.file_bytes:
            return True
        return bool(
            limits.file_sec
            and span.count
            and time_ns - span.start_ns > limits.file_sec * 1_000_000_000
        )

    def _begin_file(self) -> None:
        stem = f'{self.folder.name or self.folder.resolve().name}_{len(self._files)}'
        name = f'{stem}{self._storage.suffix}'
        self._files.append((name, Span()))
        self._file = self._storage.write(self.folder / name, self._preset)
        for topic in self._topics.values():
            self._file.add_topic(topic.metadata, topic.definition)

    def _metadata(self) -> BagMetadata:
        topics = self._topics.values()
        return BagMetadata(
            storage_identifier=self._storage.id,
            relative_file_paths=[name for name, _ in self._files],
            files=[
                FileInformation(name, span.start, span.duration, span.count)
                for name, span in self._files
            ],
            duration=self._all.duration,
            starting_time=self._all.start,
            message_count=sum(topic.count for topic in topics),
            topics_with_message_count=[
                TopicInformation(topic.metadata, topic.count) for topic in topics
            ],
            custom_data=self._custom_data,
            ros_distro=ROS_DISTRO,
        )
