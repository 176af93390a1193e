# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`rosbag2_py.SequentialWriter`: a whole bag, whatever has ended the program."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from itertools import count
from pathlib import Path
import signal
import subprocess
import sys
import time
from typing import Any

from mcap.writer import Writer
from playpen_testing.bags import (
    opened_reader,
    opened_writer,
    rest_of,
    string,
    times_of,
)
import pytest
from rclpy.duration import Duration
from rclpy.time import Time
import rosbag2_py
from rosbag2_py import (
    ConverterOptions,
    SequentialWriter,
    StorageOptions,
    TopicMetadata,
)
from rosbag2_py.bag_writer import BagWriter
from rosbag2_py.storages import storage_of
import yaml


def test_a_bag_is_described_in_its_metadata(tmp_path: Path) -> None:
    writer = SequentialWriter()
    writer.open(
        StorageOptions(uri=str(tmp_path / 'mine'), custom_data={'robot': 'husky'}),
        ConverterOptions(),
    )
    qos = rosbag2_py._storage.QoS(3).best_effort()
    topic = TopicMetadata(
        id=0,
        name='/chatter',
        type='std_msgs/msg/String',
        serialization_format='cdr',
        offered_qos_profiles=[qos],
        type_description_hash='RIHS01_x',
    )
    writer.create_topic(topic)
    writer.create_topic(topic)  # again, which changes nothing
    for time_ns in (500, 100, 300):
        writer.write('/chatter', string(time_ns), time_ns, 7)
    writer.close()
    writer.close()

    text = (tmp_path / 'mine' / 'metadata.yaml').read_text()
    content = yaml.safe_load(text)['rosbag2_bagfile_information']
    assert (content['version'], content['message_count']) == (9, 3)
    assert content['duration'] == {'nanoseconds': 400}
    assert content['starting_time'] == {'nanoseconds_since_epoch': 100}
    assert content['relative_file_paths'] == ['mine_0.mcap']
    assert content['files'][0]['message_count'] == 3
    assert content['custom_data'] == {'robot': 'husky'}
    (told,) = content['topics_with_message_count']
    assert told['topic_metadata']['offered_qos_profiles'][0]['reliability'] == 'best_effort'
    assert told['topic_metadata']['type_description_hash'] == 'RIHS01_x'

    bag = rosbag2_py.Info().read_metadata(str(tmp_path / 'mine'), 'mcap')
    assert (bag.starting_time, bag.duration) == (Time(nanoseconds=100), Duration(nanoseconds=400))
    assert bag.bag_size == sum(file.stat().st_size for file in (tmp_path / 'mine').iterdir())
    assert bag.topics_with_message_count[0].topic_metadata.equals(topic)
    assert (bag.ros_distro, bag.storage_identifier) == ('jazzy', 'mcap')
    assert 'Topic: /chatter | Type: std_msgs/msg/String | Count: 3 | ' in repr(bag)
    metadata_io = rosbag2_py.MetadataIo()
    again = metadata_io.deserialize_metadata(metadata_io.serialize_metadata(bag))
    again.bag_size = bag.bag_size
    assert repr(again) == repr(bag)


STORAGES = pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])


def start(code: str, folder: Path, storage: str = 'mcap') -> subprocess.Popen[str]:
    head = (
        'import sys, rosbag2_py\n'
        'from rosbag2_py import *\n'
        'writer = SequentialWriter()\n'
        'writer.open(StorageOptions(sys.argv[1], sys.argv[2]), ConverterOptions())\n'
        "writer.create_topic(TopicMetadata(0, 'n', 'std_msgs/msg/String', 'cdr'))\n"
    )
    return subprocess.Popen(
        [sys.executable, '-c', head + code, str(folder), storage],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_a_program_need_not_close_its_bag(tmp_path: Path) -> None:
    code = "writer.write('n', bytes(8), 5)\nkept = {'a': [writer]}\nkept['b'] = kept\n1 / 0"
    process = start(code, tmp_path / 'bag')
    assert 'ZeroDivisionError' in process.communicate(timeout=20)[1]
    assert (tmp_path / 'bag' / 'metadata.yaml').is_file()
    assert times_of(opened_reader(tmp_path / 'bag')) == [5]


LOOP = """
import itertools
for number in itertools.count():
    writer.write('n', number.to_bytes(8, 'little') * 100, number)
    if number == 5000:
        print('many', flush=True)
"""


@STORAGES
def test_ctrl_c_at_any_moment_leaves_a_whole_bag(tmp_path: Path, storage: str) -> None:
    for number in range(2):
        folder = tmp_path / f'bag{number}'
        process = start(LOOP, folder, storage)
        assert process.stdout is not None
        assert process.stdout.readline() == 'many\n'
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)
        assert process.returncode == -signal.SIGINT
        reader = opened_reader(folder)
        read = rest_of(reader)
        assert len(read) == reader.get_metadata().message_count > 5000
        for place, (_, data, time_ns) in enumerate(read):
            assert (time_ns, data) == (place, place.to_bytes(8, 'little') * 100)


INTERRUPTED = """
import os, signal, threading
ended, waits = writer._thread._ended, threading.Event()
wait = ended.wait
def wait_and_tell():
    waits.set()
    wait()
def interrupt():
    waits.wait(10)
    os.kill(os.getpid(), signal.SIGINT)
ended.wait = wait_and_tell
writer._thread.put(0, interrupt)
for number in range(5000):
    writer.write('n', bytes(100), number)
try:
    writer.close()
except KeyboardInterrupt:
    print('interrupted, whole' if ended.is_set() else 'interrupted')
"""


def test_ctrl_c_while_closing_waits_for_the_rest(tmp_path: Path) -> None:
    # In a process of its own: where a test has left rclpy's handlers, its thread shuts down
    # contexts at SIGINT that are no more.
    process = start(INTERRUPTED, tmp_path / 'bag')
    assert process.communicate(timeout=20) == ('interrupted, whole\n', '')
    assert len(rest_of(opened_reader(tmp_path / 'bag'))) == 5000


@STORAGES
def test_what_a_killed_program_has_written_is_read(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], storage: str
) -> None:
    folder = tmp_path / 'bag'
    process = start(LOOP, folder, storage)
    assert process.stdout is not None
    assert process.stdout.readline() == 'many\n'
    end = time.monotonic() + 10
    while sum(file.stat().st_size for file in folder.iterdir()) < 3_000_000:
        assert time.monotonic() < end, 'nothing was written within 10 s'
        time.sleep(0.01)
    process.kill()
    process.communicate()
    assert not (folder / 'metadata.yaml').exists()

    reader = opened_reader(folder)
    assert 'its recording was killed' in capfd.readouterr().err
    times = times_of(reader)
    assert times == list(range(len(times)))
    assert len(times) * 800 > 1_900_000
    assert reader.get_metadata().message_count == len(times)
    reader.seek(100)
    assert reader.read_next()[2] == 100
    rosbag2_py.Reindexer().reindex(StorageOptions(uri=str(folder), storage_id=storage))
    assert rosbag2_py.MetadataIo().read_metadata(str(folder)).message_count == len(times)


def test_a_writer_begins_new_files(tmp_path: Path) -> None:
    folder = tmp_path / 'bag'
    writer = opened_writer(folder, 'n', max_bagfile_duration=2, start_time_ns=10**9)
    for second in range(10):
        writer.write('n', string(second), second * 10**9)
    writer.close()
    bag = rosbag2_py.Info().read_metadata(str(folder), '')
    assert [file.message_count for file in bag.files] == [3, 3, 3]
    assert [file.duration for file in bag.files] == [timedelta(seconds=2)] * 3
    assert bag.files[1].starting_time == Time(seconds=4)
    assert times_of(opened_reader(folder)) == [n * 10**9 for n in range(1, 10)]


def test_a_snapshot_has_the_last_messages(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder, size = tmp_path / 'bag', len(string(1))
    writer = opened_writer(folder, 'n', 'm', snapshot_mode=True, max_cache_size=3 * size)
    for number in range(6):
        writer.write('n', string(number), number)
    assert writer.take_snapshot()
    assert writer.take_snapshot()  # of nothing
    writer.write('n', bytes(3 * size + 1), 6)  # more than there is room for
    writer.write('m', string(7), 7)
    writer.write('n', string(8), 8)
    writer.remove_topic(TopicMetadata(0, 'm', '', ''))
    assert writer.take_snapshot()
    writer.write('n', string(9), 9)
    writer.close()
    assert times_of(opened_reader(folder)) == [3, 4, 5, 8]
    assert "A message of 'n' is dropped: it has" in capfd.readouterr().err


def test_without_the_mode_there_is_no_snapshot(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    writer = opened_writer(tmp_path / 'bag', 'n')
    assert not writer.take_snapshot()
    assert 'no snapshot_mode=True' in capfd.readouterr().err


def test_full_disks_are_told(tmp_path: Path) -> None:
    writer = opened_writer(tmp_path / 'bag', 'n')
    mcap: Any = writer._writer._file
    mcap._file.close()  # as if the system had
    mcap._file = Path('/dev/full').open('wb')  # noqa: SIM115
    mcap._writer = Writer(mcap._file, 100)

    def write_on() -> None:
        for number in count():
            writer.write('n', bytes(9000), number)

    with pytest.raises(RuntimeError, match=r"bag' cannot be written: .*No space left"):
        write_on()
    with pytest.raises(RuntimeError, match='No space left'):
        writer.close()


def test_an_unknown_type_is_written_without_definition(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    writer = opened_writer(tmp_path / 'bag')
    writer.create_topic(TopicMetadata(0, 'n', 'no_such_msgs/msg/Thing', 'cdr'))
    writer.write('n', b'1234', 1)
    writer.close()
    assert "Unknown package 'no_such_msgs'" in capfd.readouterr().err
    assert rest_of(opened_reader(tmp_path / 'bag')) == [('n', b'1234', 1)]


def test_a_file_that_cannot_be_begun_is_no_part_of_the_bag(tmp_path: Path) -> None:
    folder = tmp_path / 'bag'
    with BagWriter(folder, storage_of('mcap')) as writer:
        writer.add_topic(TopicMetadata(0, 'n', 'std_msgs/msg/String', 'cdr'))
        writer.write('n', string(0), 7, 7)
        (folder / 'bag_1.mcap').symlink_to('/dev/full')
        with pytest.raises(RuntimeError, match="bag' cannot be written: No space left on device"):
            writer.split()
    assert times_of(opened_reader(folder)) == [7]


def test_a_bag_interrupted_as_it_begins_leaves_no_folder(tmp_path: Path) -> None:
    storage, folder = storage_of('mcap'), tmp_path / 'bag'

    def interrupted(path: Path, preset: str) -> Any:
        storage.write(path, preset).finish(rosbag2_py.BagMetadata())
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        BagWriter(folder, replace(storage, write=interrupted))
    assert not folder.exists()
    BagWriter(folder, storage).close()  # under the same name
    assert (folder / 'metadata.yaml').is_file()
