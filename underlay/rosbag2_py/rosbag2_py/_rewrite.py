# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write bags into others: merged, split, some topics only, or stored in another way."""

from __future__ import annotations

from collections import defaultdict
from contextlib import closing, ExitStack
import heapq
from pathlib import Path

from rosbag2_py._compression_options import CompressionMode, CompressionOptions
from rosbag2_py._fields import check_kind
from rosbag2_py._log import warn
from rosbag2_py._metadata import TopicMetadata
from rosbag2_py._options import ConverterOptions, StorageOptions
from rosbag2_py._output_bags import OutputBag, read_output_bags
from rosbag2_py._reader import SequentialReader, stored_messages
from rosbag2_py._writer import (
    add_topic,
    SequentialCompressionWriter,
    SequentialWriter,
    storage_to_write,
)
from rosbag2_py.bag_writer import already_there
from rosbag2_py.errors import BagError


def bag_rewrite(input_options: list[StorageOptions], output_config_file: str, /) -> None:
    """
    Write what some bags hold into others, message by message in the order of their times.

    :param output_config_file: YAML, with StorageOptions and RecordOptions of each new bag in the
        list `output_bags`.
    :raises BagError: a bag cannot be read or made, or an option is not understood.
    """
    outputs = read_output_bags(Path(output_config_file))
    readers = []
    for options in input_options:
        check_kind(options, StorageOptions)
        readers.append(SequentialReader())
        readers[-1].open(options, ConverterOptions())
    if not readers:
        raise BagError('There is no bag to read: name one')
    _check(outputs)
    topics = _topics_of(readers)
    definitions = {
        each.topic_type: each
        for reader in readers
        for each in reader.get_all_message_definitions()
    }
    takers: defaultdict[str, list[SequentialWriter]] = defaultdict(list)
    with ExitStack() as stack:
        for output in outputs:
            writer = stack.enter_context(closing(_writer_of(output)))
            writer.open(output.storage, ConverterOptions())
            for name, topic in topics.items():
                if output.selection.wants(name, topic.type):
                    add_topic(writer, topic, definitions.get(topic.type))
                    takers[name].append(writer)
            if not any(writer in each for each in takers.values()):
                hint = 'write all_topics: true, or topics: [/NAME]; ' * output.selection.is_empty()
                there = ', '.join(topics) or 'none'
                warn(f"'{output.storage.uri}' gets no message: {hint}the topics are {there}")
        streams = [stored_messages(reader) for reader in readers]
        for message in heapq.merge(*streams, key=lambda each: each.time_ns):
            for writer in takers[message.topic]:
                writer.write(message.topic, message.data, message.time_ns, message.published_ns)


def _check(outputs: list[OutputBag]) -> None:
    """Refuse what cannot be made, before the first bag is."""
    folders: set[Path] = set()
    for output in outputs:
        if output.storage.snapshot_mode:
            raise BagError('snapshot_mode: nobody asks for a snapshot while bags are converted')
        storage_to_write(output.storage, ConverterOptions())
        _writer_of(output)
        folder = Path(output.storage.uri).absolute()
        if folder in folders or folder.exists():
            raise already_there(output.storage.uri)
        folders.add(folder)


def _writer_of(output: OutputBag) -> SequentialWriter:
    mode, name = output.selection.compression_mode, output.selection.compression_format
    if mode is CompressionMode.NONE:
        return SequentialWriter()
    return SequentialCompressionWriter(CompressionOptions(name, mode))


def _topics_of(readers: list[SequentialReader]) -> dict[str, TopicMetadata]:
    """Return the topics of all bags; whose types differ is left out."""
    every: defaultdict[str, list[TopicMetadata]] = defaultdict(list)
    for reader in readers:
        for topic in reader.get_all_topics_and_types():
            every[topic.name].append(topic)
    topics = {}
    for name, same in every.items():
        types = {topic.type for topic in same}
        if len(types) > 1:
            warn(f"'{name}' has several types and is left out: {', '.join(sorted(types))}")
            continue
        first = same[0]
        topics[name] = TopicMetadata(
            first.id,
            name,
            first.type,
            first.serialization_format,
            [qos for topic in same for qos in topic.offered_qos_profiles],
            first.type_description_hash,
        )
    return topics
