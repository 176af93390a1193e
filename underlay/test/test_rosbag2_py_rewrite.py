# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`rosbag2_py.bag_rewrite`: bags merged, split, filtered and stored in another way."""

from __future__ import annotations

import os
from pathlib import Path
import signal
import subprocess
import sys
import time

from mcap.reader import make_reader
from mcap.writer import Writer
from playpen_testing.bags import numbers_in, opened_reader, opened_writer, rest_of, string
import pytest
from rclpy.serialization import serialize_message
from rosbag2_py import (
    bag_files,
    bag_rewrite,
    MetadataIo,
    Reindexer,
    StorageOptions,
    TopicMetadata,
)
from rosbag2_py.errors import BagError
from std_msgs.msg import String

EVENTS = '/add/_service_event'
MANY = 10_000
# `ros2`, which waits to be interrupted where only the last message is left.
WITHOUT_END = f"""
import itertools, sys, time
from ros2cli.cli import main
from rosbag2_py import SequentialWriter

def write_all_but_one(self, *message):
    while next(count) >= {MANY - 1}:
        time.sleep(0.01)
    write(self, *message)

count, write = itertools.count(), SequentialWriter.write
SequentialWriter.write = write_all_but_one
sys.exit(main())
"""


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """Return a bag with 12 messages of four topics, in two files."""
    writer = opened_writer(tmp_path / 'bag', '/chatter', '/other', '/_hidden')
    kind = 'example_interfaces/srv/AddTwoInts_Event'
    writer.create_topic(
        TopicMetadata(0, EVENTS, kind, 'cdr', type_description_hash='RIHS01_events')
    )
    for number in range(12):
        topic = ('/chatter', '/other', '/_hidden', EVENTS)[number % 4]
        writer.write(topic, string(number), 1000 + number, 900 + number)
        if number == 5:
            writer.split_bagfile()
    writer.close()
    return tmp_path / 'bag'


def rewrite(folder: Path, options: str, *bags: Path) -> None:
    file = folder / 'new.yaml'
    file.write_text('output_bags:\n' + options.replace('uri: ', f'uri: {folder}/'))
    bag_rewrite([StorageOptions(str(bag)) for bag in bags], str(file))


@pytest.mark.parametrize(
    ('options', 'numbers'),
    [
        ('all_topics: true', [0, 1, 4, 5, 8, 9]),
        ('all_topics: true, include_hidden_topics: true', [0, 1, 2, 4, 5, 6, 8, 9, 10]),
        ('all: true', [0, 1, 3, 4, 5, 7, 8, 9, 11]),
        ('all_services: true, all: false', [3, 7, 11]),
        ('topics: [/other], services: [/add]', [1, 3, 5, 7, 9, 11]),
        (f'services: [{EVENTS}]', [3, 7, 11]),
        ('all_services: true, exclude_services: [/add], topics: [/chatter]', [0, 4, 8]),
        ('topic_types: [std_msgs/msg/String], exclude_topics: [/other]', [0, 4, 8]),
        ('regex: "^/ch|add"', [0, 3, 4, 7, 8, 11]),
        ('all_topics: true, exclude_regex: chat', [1, 5, 9]),
        ('all_topics: true, exclude: chat, node_prefix: it_has_none', [1, 5, 9]),
        ('all_topics: true, exclude_topic_types: [std_msgs/msg/String]', []),
        ('all_topics: true, start_time_ns: 1004, end_time_ns: 1008', [4, 5, 8]),
    ],
)
def test_topics_are_chosen_as_upstream_chooses_them(
    bag: Path, tmp_path: Path, options: str, numbers: list[int]
) -> None:
    rewrite(tmp_path, f'- {{uri: new, {options}}}', bag)
    reader = opened_reader(tmp_path / 'new')
    assert numbers_in(rest_of(reader)) == numbers


@pytest.mark.parametrize('source', ['mcap', 'sqlite3'])
@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_each_storage_becomes_each(bag: Path, tmp_path: Path, source: str, storage: str) -> None:
    everything = 'all: true, include_hidden_topics: true'
    rewrite(tmp_path, f'- {{uri: between, storage_id: {source}, {everything}}}', bag)
    options = f'- {{uri: new, storage_id: {storage}, {everything}}}'
    rewrite(tmp_path, options, tmp_path / 'between')
    old, new = opened_reader(bag), opened_reader(tmp_path / 'new', storage)
    assert rest_of(new) == rest_of(old)
    described = bag_files.describe(tmp_path / 'new', storage)
    assert described.message_count == 12
    topics = {each.name: each for each in new.get_all_topics_and_types()}
    for topic in old.get_all_topics_and_types():
        assert topics[topic.name].type == topic.type
        assert topics[topic.name].type_description_hash == topic.type_description_hash
    assert topics[EVENTS].type_description_hash == 'RIHS01_events'


def test_a_message_keeps_the_time_of_its_publication(bag: Path, tmp_path: Path) -> None:
    rewrite(tmp_path, '- {uri: new, storage_preset_profile: zstd_fast, all_topics: true}', bag)
    with (tmp_path / 'new' / 'new_0.mcap').open('rb') as stream:
        times = [(m.log_time, m.publish_time) for _, _, m in make_reader(stream).iter_messages()]
    assert times == [(1000 + n, 900 + n) for n in (0, 1, 4, 5, 8, 9)]


def test_definitions_are_taken_along_where_nobody_knows_the_type(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    with (tmp_path / 'their.mcap').open('wb') as stream:
        writer = Writer(stream)
        writer.start()
        thing = writer.register_schema('their_msgs/msg/Thing', 'ros2msg', b'int32 size')
        own = writer.register_channel('/own', 'cdr', thing)
        writer.add_message(own, 7, b'\0\1\0\0\3\0\0\0', 5)
        writer.finish()
    rewrite(tmp_path, '- {uri: new, all_topics: true}', tmp_path / 'their.mcap')
    assert capfd.readouterr().err == ''
    with (tmp_path / 'new' / 'new_0.mcap').open('rb') as stream:
        ((schema, channel, message),) = make_reader(stream).iter_messages()
    assert schema is not None
    assert (schema.name, schema.data) == ('their_msgs/msg/Thing', b'int32 size')
    assert (channel.topic, message.data[4:]) == ('/own', b'\3\0\0\0')


def test_bags_are_merged_in_the_order_of_their_times(tmp_path: Path) -> None:
    for name, numbers in (('even', range(0, 10, 2)), ('odd', range(1, 10, 2))):
        writer = opened_writer(tmp_path / name, '/chatter', f'/{name}')
        for number in numbers:
            writer.write('/chatter', string(number), number)
        writer.close()
    rewrite(tmp_path, '- {uri: new, all_topics: true}', tmp_path / 'odd', tmp_path / 'even')
    reader = opened_reader(tmp_path / 'new')
    assert numbers_in(rest_of(reader)) == list(range(10))
    names = {topic.name for topic in reader.get_all_topics_and_types()}
    assert names == {'/chatter', '/even', '/odd'}


def test_a_topic_of_two_types_is_left_out_and_named(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    opened_writer(tmp_path / 'one', '/chatter').close()
    writer = opened_writer(tmp_path / 'two', '/other')
    writer.create_topic(TopicMetadata(0, '/chatter', 'std_msgs/msg/Int32', 'cdr'))
    writer.close()
    rewrite(tmp_path, '- {uri: new, all_topics: true}', tmp_path / 'one', tmp_path / 'two')
    (topic,) = opened_reader(tmp_path / 'new').get_all_topics_and_types()
    assert topic.name == '/other'
    types = 'std_msgs/msg/Int32, std_msgs/msg/String'
    assert f"'/chatter' has several types and is left out: {types}" in capfd.readouterr().err


def test_a_bag_becomes_several_and_each_several_files(bag: Path, tmp_path: Path) -> None:
    options = '- {uri: one, topics: [/chatter]}\n- {uri: two, topics: [/chatter, /other]}'
    rewrite(tmp_path, options, bag)
    assert numbers_in(rest_of(opened_reader(tmp_path / 'one'))) == [0, 4, 8]
    assert numbers_in(rest_of(opened_reader(tmp_path / 'two'))) == [0, 1, 4, 5, 8, 9]
    writer = opened_writer(tmp_path / 'long', '/chatter')
    for number in range(10):
        writer.write('/chatter', string(number), number * 10**9)
    writer.close()
    rewrite(
        tmp_path, '- {uri: split, all_topics: true, max_bagfile_duration: 3}', tmp_path / 'long'
    )
    metadata = MetadataIo().read_metadata(str(tmp_path / 'split'))
    assert [file.message_count for file in metadata.files] == [4, 4, 2]
    assert numbers_in(rest_of(opened_reader(tmp_path / 'split'))) == list(range(10))


def test_an_empty_bag_is_told_with_what_there_is(
    bag: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    rewrite(tmp_path, '- {uri: new, topics: [/chater]}\n- {uri: none}', bag)
    told = capfd.readouterr().err
    assert "new' gets no message: the topics are /chatter, /other, /_hidden, " in told
    assert "none' gets no message: write all_topics: true, or topics: [/NAME]; the top" in told
    assert not opened_reader(tmp_path / 'none').has_next()


@pytest.mark.parametrize(
    ('options', 'refused'),
    [
        ('{uri: new, topic: [/a]}', 'number 2: there is no option topic; did you mean topics?'),
        ('{uri: new, 3: 4}', 'there is no option 3; there are uri, storage_id, '),
        ('{uri: new, topics: /a}', "number 2: topics='/a': it takes a list"),
        ('{uri: new, snapshot_mode: true, max_cache_size: 9}', 'nobody asks for a snapshot'),
        ('{uri: new, topics: }', 'topics=None: it takes a list'),
        ('{uri: new, all_topics: 1}', 'all_topics=1: it takes true or false'),
        ('{uri: new, regex: "["}', "'[' is no regular expression"),
        ('{uri: new, all_topics: true, storage_id: sqlite}', "'sqlite'"),
        ('{uri: new, all_topics: true, max_bagfile_size: -1}', 'max_bagfile_size=-1: it takes a'),
        ('{uri: new, all_topics: true, compression_mode: all}', 'it takes none, file or message'),
        ('{uri: new, all_topics: true, compression_mode: file}', "format='': here it is zstd"),
        ('{uri: new, all_topics: true}\n- {uri: new, all_topics: true}', "new' already exists"),
        ('{uri: bag, all_topics: true}', "bag' already exists, and no bag is written over"),
        ('{all_topics: true}', 'number 2: it has no uri, the folder to make'),
        ('new', "number 2: 'new' is no options; a bag has at least a uri"),
        ('{uri: new', 'is no YAML: '),
    ],
)
def test_what_is_not_understood_is_refused_before_a_bag_is_made(
    bag: Path, tmp_path: Path, options: str, refused: str
) -> None:
    with pytest.raises(BagError) as error:
        rewrite(tmp_path, f'- {{uri: first, all_topics: true}}\n- {options}', bag)
    assert refused in str(error.value)
    assert sorted(path.name for path in tmp_path.iterdir()) == ['bag', 'new.yaml']


@pytest.mark.parametrize('content', ['', '[]', 'output_bags:', 'output_bags: {uri: a}', '3'])
def test_a_file_without_bags_is_told_what_to_write(tmp_path: Path, content: str) -> None:
    (tmp_path / 'new.yaml').write_text(content)
    with pytest.raises(
        BagError,
        match=r'has no list output_bags; for one bag write output_bags: \[{uri: \w+, all_',
    ):
        bag_rewrite([], str(tmp_path / 'new.yaml'))


def test_files_that_cannot_be_read_are_refused(bag: Path, tmp_path: Path) -> None:
    with pytest.raises(BagError, match=r"none\.yaml' cannot be read: No such file"):
        bag_rewrite([StorageOptions(str(bag))], str(tmp_path / 'none.yaml'))
    (tmp_path / 'latin.yaml').write_bytes(b'\xe4')
    with pytest.raises(BagError, match='is no text in UTF-8'):
        bag_rewrite([StorageOptions(str(bag))], str(tmp_path / 'latin.yaml'))
    for text in ('[' * 5000, 'a: 2001-99-99'):
        (tmp_path / 'odd.yaml').write_text(text)
        with pytest.raises(BagError, match=r"odd\.yaml' is no YAML: m"):  # maximum, month
            bag_rewrite([StorageOptions(str(bag))], str(tmp_path / 'odd.yaml'))
    with pytest.raises(BagError, match='none'):
        rewrite(tmp_path, '- {uri: new, all_topics: true}', tmp_path / 'none')
    assert not (tmp_path / 'new').exists()


@pytest.fixture(scope='module')
def long_bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a bag that is not written in one go; it is only read."""
    folder = tmp_path_factory.mktemp('long') / 'bag'
    writer = opened_writer(folder, '/chatter')
    for count in range(MANY):
        text = f'number {count} {"x" * 1000}'
        writer.write('/chatter', bytes(serialize_message(String(data=text))), count)
    writer.close()
    return folder


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_command_leaves_whole_bags(
    long_bag: Path, tmp_path: Path, number: signal.Signals
) -> None:
    (tmp_path / 'new.yaml').write_text('output_bags: [{uri: new, all_topics: true}]')
    words = ['bag', 'convert', '-i', str(long_bag), '-o', 'new.yaml']
    command = [sys.executable, '-c', WITHOUT_END, *words]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as running:
        file = tmp_path / 'new' / 'new_0.mcap'
        deadline = time.monotonic() + 20.0
        while not (file.exists() and file.stat().st_size > 4_000_000):
            assert time.monotonic() < deadline, 'nothing was written within 20 s'
            time.sleep(0.005)
        running.send_signal(number)
        _, told = running.communicate(timeout=10.0)
    assert 'Traceback' not in told
    assert running.returncode == {signal.SIGINT: 2, signal.SIGTERM: -signal.SIGTERM}[number]
    written = numbers_in(rest_of(opened_reader(tmp_path / 'new')))
    assert written == list(range(len(written)))
    assert 0 < len(written) < MANY


def test_the_commands_convert_and_reindex(bag: Path, tmp_path: Path) -> None:
    def ros2(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, '-m', 'ros2cli', 'bag', *words]
        return subprocess.run(
            command, cwd=tmp_path, env=os.environ, capture_output=True, text=True, timeout=30
        )

    (tmp_path / 'new.yaml').write_text('output_bags: [{uri: new, all_topics: true}]')
    done = ros2('convert', '-i', 'bag', 'mcap', '-o', 'new.yaml')
    assert (done.stdout, done.stderr, done.returncode) == ('', '', 0)
    assert numbers_in(rest_of(opened_reader(tmp_path / 'new'))) == [0, 1, 4, 5, 8, 9]
    refused = ros2('convert', '-i', 'bag', 'mcap', 'bag2', '-o', 'new.yaml')
    assert refused.returncode == 2
    assert '--input takes a bag and its storage, not bag mcap bag2' in refused.stderr
    again = ros2('convert', '-i', 'bag', '-o', 'new.yaml')
    assert again.stderr.count('\n') == 1
    assert "'new' already exists, and no bag is written over" in again.stderr

    (tmp_path / 'new' / 'metadata.yaml').unlink()
    done = ros2('reindex', 'new')
    assert (done.stdout, done.stderr, done.returncode) == ('', '', 0)
    assert MetadataIo().read_metadata(str(tmp_path / 'new')).message_count == 6
    refused = ros2('reindex', 'none')
    assert "'none' is no folder of a bag" in refused.stderr


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_to_reindex_in_vain_leaves_the_metadata(tmp_path: Path, storage: str) -> None:
    folder, told = tmp_path / 'bag', {'robot': 'husky'}
    writer = opened_writer(folder, '/chatter', storage_id=storage, custom_data=told)
    writer.split_bagfile()
    writer.close()
    before = (folder / 'metadata.yaml').read_bytes()
    (last,) = folder.glob('bag_1.*')
    last.write_bytes(b'no file of a bag')
    with pytest.raises(BagError, match=r'bag_1.* cannot be read as'):
        Reindexer().reindex(StorageOptions(str(folder)))
    assert (folder / 'metadata.yaml').read_bytes() == before

    # A file that metadata.yaml does not name, or names in vain, does not matter.
    last.unlink()
    Reindexer().reindex(StorageOptions(str(folder)))
    bag = MetadataIo().read_metadata(str(folder))
    assert (len(bag.relative_file_paths), bag.custom_data) == (1, told)
