# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`rosbag2_py.SequentialReader`: every message once, from bags of any writer."""

from __future__ import annotations

from collections.abc import Iterator
import importlib
import os
from pathlib import Path
from typing import Any

from husky_grader.report.mcap_file import Topic, write_mcap
from matplotlib.figure import Figure
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from nav_msgs.msg import Odometry
from playpen_testing.bags import (
    numbers_in,
    opened_reader,
    opened_writer,
    rest_of,
    string,
    times_of,
    write_metadata,
)
import pytest
from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.time import Time
import rosbag2_py
from rosbag2_py import (
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
)
from rosidl_runtime_py.utilities import get_message
import yaml

QOS = """
- history: {history}
  depth: 7
  reliability: {reliability}
  durability: {durability}
  deadline: {{sec: 9223372036, nsec: 854775807}}
  lifespan: {{sec: 1, nsec: 5}}
  liveliness: {liveliness}
  liveliness_lease_duration: {{sec: 0, nsec: 0}}
  avoid_ros_namespace_conventions: false
"""
WORDS = QOS.format(
    history='keep_last',
    reliability='best_effort',
    durability='transient_local',
    liveliness='automatic',
)
NUMBERS = QOS.format(history=1, reliability=2, durability=1, liveliness=1)


@pytest.fixture(params=['mcap', 'sqlite3'])
def bag(tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    """Write a bag of three files, with times from 0 to 29 and two topics in turn."""
    writer = opened_writer(tmp_path / 'bag', '/even', '/odd', storage_id=request.param)
    for number in range(30):
        if number in (10, 20):
            writer.split_bagfile()
        writer.write(('/even', '/odd')[number % 2], string(number), number)
    writer.close()
    return tmp_path / 'bag'


@pytest.mark.parametrize('bag', ['mcap'], indirect=True)
def test_other_readers_of_mcap_decode_what_is_written(bag: Path) -> None:
    decoder = importlib.import_module('mcap_ros2.decoder').DecoderFactory()
    with (bag / 'bag_1.mcap').open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[decoder])
        texts = [message[3].data for message in reader.iter_decoded_messages()]
        assert [each.name for each in reader.iter_metadata()] == ['rosbag2']
    assert texts == [f'number {number}' for number in range(10, 20)]


def test_files_are_read_one_after_another(bag: Path) -> None:
    reader = opened_reader(bag)
    topics = reader.get_all_topics_and_types()
    assert {each.name: each.type for each in topics} == dict.fromkeys(
        ('/even', '/odd'), 'std_msgs/msg/String'
    )
    stems = [Path(name).stem for name in reader.get_metadata().relative_file_paths]
    assert stems == [f'bag_{n}' for n in range(3)]
    assert numbers_in(rest_of(reader)) == list(range(30))
    assert not reader.has_next()
    with pytest.raises(RuntimeError, match='no further message'):
        reader.read_next()
    (definition,) = reader.get_all_message_definitions()
    assert (definition.topic_type, definition.encoding) == ('std_msgs/msg/String', 'ros2msg')
    assert 'string data' in definition.encoded_message_definition


def test_a_filter_keeps_the_place(bag: Path) -> None:
    reader = opened_reader(bag)
    assert reader.read_next()[2] == 0
    reader.set_filter(StorageFilter(topics=['/even']))
    assert reader.has_next()  # which looks ahead, past what the filter leaves out
    reader.reset_filter()
    assert reader.read_next()[2] == 1
    reader.set_filter(StorageFilter(exclude_topics=['/even']))
    assert [reader.read_next()[2] for _ in range(5)] == [3, 5, 7, 9, 11]
    reader.set_filter(StorageFilter(regex='/ev.*'))
    assert times_of(reader) == list(range(12, 30, 2))
    reader.set_filter(StorageFilter(regex='ev'))  # must match the whole name
    reader.seek(0)
    assert not reader.has_next()
    for regex, times in (('/ev.*', range(1, 30, 2)), ('ev', range(30))):
        reader.set_filter(StorageFilter(regex_to_exclude=regex))
        reader.seek(0)
        assert times_of(reader) == list(times), regex


def test_seeking_goes_through_all_files(bag: Path) -> None:
    reader = opened_reader(bag)
    reader.seek(25)
    assert times_of(reader) == [25, 26, 27, 28, 29]
    reader.seek(3)
    reader.set_filter(StorageFilter(topics=['/odd']))
    assert times_of(reader) == list(range(3, 30, 2))
    reader.seek(1000)
    assert not reader.has_next()
    reader.seek(-5)
    with pytest.raises(TypeError, match=r'write .nanoseconds behind it'):
        reader.seek(Time())
    assert len(rest_of(reader)) == 15


@pytest.mark.timeout(20)
@pytest.mark.parametrize('storage_id', ['mcap', 'sqlite3'])
def test_a_time_between_two_files_is_sought(tmp_path: Path, storage_id: str) -> None:
    writer = opened_writer(tmp_path / 'bag', '/a', storage_id=storage_id)
    times = (10, 20, 100, 110)
    for time in times:
        if time == 100:
            writer.split_bagfile()  # and a file without messages
            writer.split_bagfile()
        writer.write('/a', string(time), time)
    writer.close()
    reader = opened_reader(tmp_path / 'bag')
    for reverse in (False, True):
        assert reader.set_read_order(ReadOrder(ReadOrderSortBy.ReceivedTimestamp, reverse))
        for sought in (50, 105, 15, 99, 20, 200, 100, 5):
            reader.seek(sought)
            if reverse:
                assert times_of(reader) == [t for t in times[::-1] if t <= sought], sought
            else:
                assert times_of(reader) == [t for t in times if t >= sought], sought


def test_a_bag_is_read_backwards(bag: Path) -> None:
    reader = opened_reader(bag)
    assert reader.set_read_order(ReadOrder(ReadOrderSortBy.ReceivedTimestamp, reverse=True))
    reader.seek(29)
    assert times_of(reader) == list(range(29, -1, -1))
    assert not reader.set_read_order(ReadOrder(ReadOrderSortBy.PublishedTimestamp))
    assert not reader.set_read_order(ReadOrder(ReadOrderSortBy.File, True))


def test_messages_come_by_time_or_as_written(tmp_path: Path) -> None:
    writer = opened_writer(tmp_path / 'bag', 'a', 'b')
    written = [(5, 'a'), (3, 'b'), (3, 'a'), (9, 'a'), (3, 'b'), (1, 'a')]
    for number, (time_ns, topic) in enumerate(written):
        writer.write(topic, string(number), time_ns)
    del writer
    reader = opened_reader(tmp_path / 'bag')
    assert numbers_in(rest_of(reader)) == [5, 1, 2, 4, 0, 3]
    assert reader.set_read_order(ReadOrder(sort_by=ReadOrderSortBy.File))
    reader.seek(2)
    assert numbers_in([reader.read_next(), reader.read_next()]) == [0, 1]
    reader.set_filter(StorageFilter(topics=['a']))
    assert numbers_in(rest_of(reader)) == [2, 3]
    # of one time, those that were read already do not come again
    reader = opened_reader(tmp_path / 'bag')
    assert numbers_in([reader.read_next() for _ in range(3)]) == [5, 1, 2]
    reader.set_filter(StorageFilter(topics=['b']))
    assert numbers_in(rest_of(reader)) == [4]


@pytest.mark.parametrize('compression', list(CompressionType))
@pytest.mark.parametrize('chunked', [True, False])
@pytest.mark.parametrize(('version', 'qos'), [(9, WORDS), (5, NUMBERS)])
def test_bags_of_other_writers_are_read(
    tmp_path: Path, compression: CompressionType, chunked: bool, version: int, qos: str
) -> None:
    file = tmp_path / 'real_0.mcap'
    with file.open('wb') as stream:
        writer = Writer(stream, 600, compression, use_chunking=chunked)
        writer.start('ros2')
        schema = writer.register_schema('std_msgs/msg/String', 'ros2msg', b'string data')
        told = {'offered_qos_profiles': qos}
        channel = writer.register_channel('/chatter', 'cdr', schema, told)
        for number in range(100):
            writer.add_message(channel, number, string(number), number)
        writer.finish()
    bare = opened_reader(file)
    (topic,) = bare.get_all_topics_and_types()
    assert numbers_in(rest_of(bare)) == list(range(100))
    assert bare.get_metadata().message_count == 100

    write_metadata(tmp_path, version, yaml.safe_load(qos) if version == 9 else qos)
    reader = opened_reader(tmp_path)
    (same,) = reader.get_all_topics_and_types()
    assert numbers_in(rest_of(reader)) == list(range(100))
    for (profile,) in (topic.offered_qos_profiles, same.offered_qos_profiles):
        found = rosbag2_py.convert_rclcpp_qos_to_rclpy_qos(profile)
        assert (found.depth, found.lifespan) == (7, Duration(seconds=1, nanoseconds=5))
        assert found.reliability == ReliabilityPolicy.BEST_EFFORT
        assert found.durability == DurabilityPolicy.TRANSIENT_LOCAL


@pytest.mark.parametrize('compression', [CompressionType.NONE, CompressionType.ZSTD])
@pytest.mark.parametrize(
    'without', ['', 'repeat_channels', 'repeat_schemas', 'use_statistics', 'the last chunk']
)
def test_files_that_tell_little_at_their_end_are_read(
    tmp_path: Path, compression: CompressionType, without: str, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / 'bare.mcap'
    with file.open('wb') as stream:
        options = {without: False} if '_' in without else {}
        writer = Writer(stream, 600, compression, **options)  # type: ignore[arg-type]
        writer.start('ros2')
        schema = writer.register_schema('std_msgs/msg/String', 'ros2msg', b'string data')
        channels = [
            writer.register_channel('/chatter', 'cdr', schema),
            writer.register_channel('/bare', 'cdr', 0),
        ]
        for time_ns in [*range(50, 100), *range(50)]:
            writer.add_message(channels[time_ns % 2], time_ns, string(time_ns), time_ns)
        writer.finish()
    count = 100
    if without == 'the last chunk':
        with file.open('rb') as stream:
            last = make_reader(stream).get_summary().chunk_indexes[-1]  # type: ignore[union-attr]
        os.truncate(file, last.chunk_start_offset + last.chunk_length - 1)
        count = last.message_start_time
    times = [*range(min(count, 50)), *range(50, 100)]
    reader = opened_reader(file)
    types = {topic.name: topic.type for topic in reader.get_all_topics_and_types()}
    assert types == {'/chatter': 'std_msgs/msg/String', '/bare': ''}
    assert times_of(reader) == times
    told = reader.get_metadata()
    assert (told.message_count, told.starting_time.nanoseconds) == (len(times), 0)
    assert told.duration.nanoseconds == 99
    assert ('its recording was killed' in capfd.readouterr().err) == (count < 100)
    for topics, step in (([], 1), (['/bare'], 2)):
        reader = opened_reader(file)
        assert reader.set_read_order(ReadOrder(ReadOrderSortBy.ReceivedTimestamp, reverse=True))
        reader.set_filter(StorageFilter(topics=topics))
        reader.seek(99)
        assert times_of(reader) == [time_ns for time_ns in times[::-1] if step == 1 or time_ns % 2]


def test_a_run_is_read_and_plotted(tmp_path: Path) -> None:
    """Read run.mcap as a student does, and draw the way of the robot."""

    def drive() -> Iterator[tuple[int, bytes]]:
        for number in range(200):
            odometry = Odometry()
            odometry.pose.pose.position.x = number * 0.02
            odometry.header.frame_id = 'odom'
            yield number * 20_000_000, serialize_message(odometry)

    write_mcap(tmp_path / 'run.mcap', [Topic('/odometry/filtered', Odometry, drive())])

    reader = rosbag2_py.SequentialReader()
    reader.open_uri(str(tmp_path / 'run.mcap'))
    types = {each.name: get_message(each.type) for each in reader.get_all_topics_and_types()}
    reader.set_filter(rosbag2_py.StorageFilter(topics=['/odometry/filtered']))
    seconds, ways = [], []
    while reader.has_next():
        topic, data, stamp = reader.read_next()
        odometry = deserialize_message(data, types[topic])
        seconds.append(stamp * 1e-9)
        ways.append(odometry.pose.pose.position.x)
    figure = Figure()
    (line,) = figure.subplots().plot(seconds, ways)
    figure.savefig(tmp_path / 'way.png')
    assert (seconds[-1], ways[-1]) == pytest.approx((3.98, 3.98))
    drawn: Any = line.get_xydata()
    assert drawn.tolist() == [list(each) for each in zip(seconds, ways, strict=True)]
