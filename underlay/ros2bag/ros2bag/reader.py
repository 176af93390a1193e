# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read a bag."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path

from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from ros2cli.errors import CommandError
import yaml

from ros2bag import metadata
from ros2bag.metadata import BagRecord, TopicRecord


def read_record(path: Path) -> BagRecord:
    """Read what a bag holds, from the summaries of its files.

    :raises CommandError: a file is no MCAP, or is cut short.
    """
    found: dict[str, TopicRecord] = {}
    files = metadata.bag_files(path)
    bag = BagRecord(', '.join(file.name for file in files))
    starts, ends = [], []
    for file in files:
        try:
            with file.open('rb') as stream:
                reader = make_reader(stream)
                summary = reader.get_summary()
        except Exception as error:  # of damaged bytes the libraries raise many types
            raise _unreadable(file, error) from None
        if summary is None or summary.statistics is None:
            raise CommandError(
                f"'{file}' has no summary: its recording was killed before it ended; the MCAP "
                'command line tool can mend it (`mcap recover`)'
            )
        if summary.statistics.message_count:
            starts.append(summary.statistics.message_start_time)
            ends.append(summary.statistics.message_end_time)
        for channel in summary.channels.values():
            schema = summary.schemas.get(channel.schema_id)
            topic = found.setdefault(
                channel.topic,
                _topic(channel.topic, schema.name if schema else '', channel.metadata),
            )
            topic.count += summary.statistics.channel_message_counts.get(channel.id, 0)
    bag.topics = [found[name] for name in sorted(found)]
    bag.start_ns, bag.end_ns = min(starts, default=0), max(ends, default=0)
    return bag


def messages(path: Path, topics: Collection[str]) -> Iterator[tuple[str, int, bytes]]:
    """Yield topic, time (ns since the epoch) and data of messages, in the order of their times.

    :raises CommandError: a file is damaged.
    """
    for file in metadata.bag_files(path):
        try:
            with file.open('rb') as stream:
                for _, channel, message in make_reader(stream).iter_messages(list(topics)):
                    yield channel.topic, message.log_time, message.data
        except Exception as error:  # as above
            raise _unreadable(file, error) from None


def _unreadable(file: Path, error: Exception) -> CommandError:
    why = str(error)
    if isinstance(error, EndOfFile):
        why = 'it ends too soon, as where its recording was killed'
    elif isinstance(error, KeyError):
        why = f'{type(error).__name__}: {error}'
    return CommandError(f"'{file}' cannot be read as MCAP: {why}")


def _topic(name: str, type_name: str, channel: dict[str, str]) -> TopicRecord:
    record = TopicRecord(name, type_name, channel.get('topic_type_hash', ''))
    try:
        profiles = yaml.safe_load(channel.get('offered_qos_profiles', '')) or []
        # rosbag2 wrote numbers before version 9 and names since.
        record.reliable = all(p['reliability'] in ('reliable', 1) for p in profiles)
        record.transient_local = bool(profiles) and all(
            p['durability'] in ('transient_local', 1) for p in profiles
        )
    except (yaml.YAMLError, KeyError, TypeError):
        pass  # The defaults suit every subscription.
    return record
