# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 bag`: what is recorded is what is played, and other readers of MCAP read it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import closing
import importlib
from itertools import islice
from pathlib import Path
import resource
import signal
import sqlite3
import sys
from threading import Thread
import time
from typing import Any

from mcap.reader import make_reader
from mcap.writer import Writer
from playpen_testing.bags import opened_writer, string
from playpen_testing.processes import find_line
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosbag2_py import (
    bag_files,
    BagMetadata,
    Info,
    MetadataIo,
    SequentialReader,
    TopicMetadata,
)
from rosbag2_py.errors import BagError
from service_msgs.msg import ServiceEventInfo
from std_msgs.msg import String
from std_srvs.srv import SetBool
import yaml

CHATTER, FLIPS = '/chatter', '/flip/_service_event'


def _record(processes: Any, folder: Path, *words: str, until: str) -> str:
    recorder = processes.ros2('bag', 'record', '-o', str(folder), *words, ready=until)
    time.sleep(1.0)  # The length of the recording.
    recorder.send_signal(signal.SIGINT)
    rest, _ = recorder.communicate(timeout=10)
    assert 'Traceback' not in rest
    return str(rest)


def _metadata(bag: Path) -> dict[str, Any]:
    whole: dict[str, Any] = yaml.safe_load((bag / 'metadata.yaml').read_text())
    return whole['rosbag2_bagfile_information']  # type: ignore[no-any-return]


def _counts(bag: Path) -> dict[str, int]:
    return {
        topic['topic_metadata']['name']: topic['message_count']
        for topic in _metadata(bag)['topics_with_message_count']
    }


@pytest.fixture(scope='module')
def talk(shared_processes: Any) -> Any:
    """Let a node talk; return where processes start that hear it."""
    shared_processes.node('talker', 'talker')
    return shared_processes


@pytest.fixture(scope='module')
def bag(talk: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    latched = talk.node('latched', 'latched')
    for number in range(5):  # on a busy machine its second may be over before it hears all
        folder = tmp_path_factory.mktemp(f'bag_{number}') / 'run'
        rest = _record(talk, folder, '--all', until='Recording...')
        assert 'Recording stopped: ' in rest
        counts = _counts(folder)
        if counts.get('/chatter', 0) > 5 and counts.get('/latched'):
            break
    talk.end_one(latched)
    return folder


def test_a_bag_is_recorded_described_and_played(
    bag: Path, processes: Any, ros2: Callable[..., Any]
) -> None:
    info = ros2('bag', 'info', str(bag)).out
    assert 'Storage id:        mcap' in info
    assert 'Topic: /chatter | Type: std_msgs/msg/String | Count: ' in info
    assert 'Topic: /latched | Type: std_msgs/msg/String | Count: 1 | ' in info

    content = _metadata(bag)
    assert content['version'] == 9
    assert content['relative_file_paths'] == ['run_0.mcap']
    counts = _counts(bag)
    assert counts['/chatter'] > 5

    decoder = importlib.import_module('mcap_ros2.decoder').DecoderFactory()
    with (bag / 'run_0.mcap').open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[decoder])
        decoded = list(reader.iter_decoded_messages(topics=['/chatter']))
    texts = [message[3].data for message in decoded]
    assert len(texts) == counts['/chatter']
    first = int(texts[0].split()[1])
    assert texts == [f'hello {first + i}' for i in range(len(texts))]

    listener = processes.node('listener', 'listener')
    played = ros2('bag', 'play', str(bag), '--topics', '/chatter', '--rate', '4')
    assert played.status == 0
    heard: list[str] = []
    hearing = Thread(target=lambda: heard.extend(islice(listener.stdout, len(texts))), daemon=True)
    hearing.start()
    hearing.join(20.0)
    assert heard == [f'heard {text}\n' for text in texts]


def test_sqlite3_is_recorded_described_and_played(
    processes: Any, ros2: Callable[..., Any], tmp_path: Path
) -> None:
    talker = processes.node('talker', 'talker')
    processes.node('latched', 'latched')
    recorder = processes.ros2(
        'bag', 'record', '-a', '-s', 'sqlite3', '-o', str(tmp_path / 'run'), ready='Recording...'
    )
    file = tmp_path / 'run' / 'run_0.db3'
    # What is recorded can be read at once, by whatever reads sqlite3.
    deadline = time.monotonic() + 20.0
    while _count(file, '/chatter') < 8 or _count(file, '/latched') < 1:
        assert time.monotonic() < deadline, 'not both topics were recorded within 20 s'
        time.sleep(0.05)
    recorder.send_signal(signal.SIGINT)
    rest, _ = recorder.communicate(timeout=10)
    assert 'Recording stopped: ' in rest
    processes.end_one(talker)

    assert sorted(each.name for each in file.parent.iterdir()) == ['metadata.yaml', 'run_0.db3']
    count = _count(file, '/chatter')
    info = ros2('bag', 'info', str(tmp_path / 'run')).out
    assert 'Files:             run_0.db3\n' in info
    assert 'Storage id:        sqlite3' in info
    assert f'Topic: /chatter | Type: std_msgs/msg/String | Count: {count} | ' in info
    assert _metadata(tmp_path / 'run')['storage_identifier'] == 'sqlite3'

    listener = processes.node('listener', 'listener')
    played = ros2('bag', 'play', str(file), '-s', 'sqlite3', '--topics', '/chatter', '-r', '4')
    assert (played.status, played.err.count('\n')) == (0, 1)
    data = [data for topic, data, _ in _read(file) if topic == '/chatter']
    texts = [deserialize_message(each, String).data for each in data]
    assert len(texts) == count
    for text in texts:
        find_line(listener.stdout, f'^heard {text}$')


def _count(file: Path, topic: str) -> int:
    with closing(sqlite3.connect(f'{file.as_uri()}?mode=ro', uri=True)) as opened:
        query = (
            'SELECT COUNT(*) FROM messages WHERE topic_id = (SELECT id FROM topics WHERE name=?)'
        )
        (number,) = opened.execute(query, (topic,)).fetchone()
    return int(number)


@pytest.mark.parametrize(
    ('where', 'number'), [('start', signal.SIGTERM), ('background', signal.SIGINT)]
)
def test_a_signal_ends_play_without_a_word(
    bag: Path, processes: Any, where: str, number: int
) -> None:
    listener = processes.node('listener', 'listener')
    words = (sys.executable, '-m', 'ros2cli', 'bag', 'play', str(bag), '--loop')
    player = getattr(processes, where)(*words)
    find_line(listener.stdout, '^heard ')
    player.send_signal(number)
    out, _ = player.communicate(timeout=10)
    (line,) = out.splitlines()
    assert line.endswith('Ctrl-C ends it')
    assert player.returncode == signal.SIGINT


def test_sigterm_ends_a_recording_as_ctrl_c_does(talk: Any, tmp_path: Path) -> None:
    recorder = talk.ros2('bag', 'record', '-o', str(tmp_path / 'run'), '/chatter')
    find_line(recorder.stdout, 'Recording...')
    recorder.send_signal(signal.SIGTERM)
    out, _ = recorder.communicate(timeout=10)
    assert 'Recording stopped: ' in out
    assert recorder.returncode == 0


def test_a_recording_on_a_full_disk_ends_in_one_line(talk: Any, tmp_path: Path) -> None:
    recorder = talk.ros2('bag', 'record', '-o', str(tmp_path / 'run'), '/chatter')
    find_line(recorder.stdout, 'Recording...')
    resource.prlimit(recorder.pid, resource.RLIMIT_FSIZE, (100, 100))
    recorder.send_signal(signal.SIGINT)
    out, _ = recorder.communicate(timeout=10)
    assert out.splitlines()[-1] == f"'{tmp_path / 'run'}' cannot be written: File too large"
    assert recorder.returncode == 1


def test_half_a_metadata_hides_no_bag(tmp_path: Path) -> None:
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))  # as on a disk that gets full
    try:
        with pytest.raises(OSError, match='File too large'):
            MetadataIo().write_metadata(str(tmp_path), BagMetadata())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGHUP])
def test_more_signals_leave_a_whole_bag(
    talk: Any, ros2_here: Callable[..., Any], tmp_path: Path, number: int
) -> None:
    recorder = talk.ros2('bag', 'record', '-o', str(tmp_path / 'run'), '/chatter')
    find_line(recorder.stdout, 'Recording...')
    while recorder.poll() is None:
        recorder.send_signal(number)
    assert 'Recording stopped: ' in recorder.stdout.read()
    assert recorder.returncode == 0
    assert (tmp_path / 'run' / 'metadata.yaml').is_file()
    assert ros2_here('bag', 'info', str(tmp_path / 'run')).status == 0


def test_only_chosen_topics_are_recorded(
    talk: Any, ros2_here: Callable[..., Any], tmp_path: Path
) -> None:
    _record(talk, tmp_path / 'run', '/chatter', until="Subscribed to topic '/chatter'")
    assert ros2_here('bag', 'info', '-t', str(tmp_path / 'run')).lines == ['/chatter']


def test_a_topic_that_comes_later_is_recorded(
    processes: Any, ros2_here: Callable[..., Any], tmp_path: Path
) -> None:
    recorder = processes.ros2(
        'bag', 'record', '-o', str(tmp_path / 'run'), '-e', 'chat', ready='Recording'
    )
    processes.node('talker', 'talker')
    for line in recorder.stdout:
        if "Subscribed to topic '/chatter'" in line:
            break
    recorder.terminate()
    recorder.wait(timeout=10)
    assert ros2_here('bag', 'info', '-t', str(tmp_path / 'run')).lines == ['/chatter']


def _read(file: Path) -> list[tuple[str, bytes, int]]:
    bag_files.describe(file)
    reader, found = SequentialReader(), []
    reader.open_uri(str(file))
    while reader.has_next():
        found.append(reader.read_next())
    return found


def _write_mcap(file: Path, times_ns: Iterable[int]) -> None:
    with file.open('wb') as stream:
        writer = Writer(stream, chunk_size=500)
        writer.start()
        schema = writer.register_schema('std_msgs/msg/String', 'ros2msg', b'string data')
        channel = writer.register_channel('/chatter', 'cdr', schema)
        for time_ns in times_ns:
            writer.add_message(channel, time_ns, b'message %d' % time_ns, 0)
        writer.finish()


def test_a_time_that_ros_has_not_is_a_damage(tmp_path: Path) -> None:
    _write_mcap(tmp_path / 'run.mcap', [1, 2**63])
    with pytest.raises(BagError, match=r"as MCAP: a message of '/chatter' is of after the year"):
        _read(tmp_path / 'run.mcap')


def test_a_damaged_bag_is_read_or_refused_in_words(tmp_path: Path) -> None:
    file = tmp_path / 'run.mcap'
    _write_mcap(file, range(100))
    whole = file.read_bytes()
    assert len(_read(file)) == 100
    refused = 0
    for place in range(8, len(whole) - 8, 31):
        for length in (1, 8):
            file.write_bytes(whole[:place] + b'\xff' * length + whole[place + length :])
            try:
                _read(file)
            except BagError as error:
                refused += 1
                assert 'cannot be read as MCAP' in str(error)
    assert refused > 10


def test_requests_and_responses_are_counted(tmp_path: Path, ros2_here: Callable[..., Any]) -> None:
    folder = tmp_path / 'calls'
    with closing(opened_writer(folder)) as writer:
        writer.create_topic(TopicMetadata(0, CHATTER, 'std_msgs/msg/String', 'cdr'))
        writer.create_topic(TopicMetadata(0, FLIPS, 'std_srvs/srv/SetBool_Event', 'cdr'))
        # Both sides name the clients alike, as over Cyclone DDS; the fourth call is not answered.
        for client, number in ((1, 1), (1, 2), (2, 1), (2, 3)):
            kinds = (ServiceEventInfo.REQUEST_SENT,) if number == 3 else range(4)
            for kind in kinds:
                event = SetBool.Event()
                event.info.event_type = kind
                event.info.client_gid = [client] * 16
                event.info.sequence_number = number
                writer.write(FLIPS, serialize_message(event), number)
        writer.write(CHATTER, string(1), 5)
    with closing(opened_writer(tmp_path / 'broken')) as writer:
        writer.create_topic(TopicMetadata(0, FLIPS, 'std_srvs/srv/SetBool_Event', 'cdr'))
        writer.write(FLIPS, b'no event', 0)
    calls = [
        *((str(folder), '--verbose'), (str(folder), '-t'), (str(folder), '-t', '-v')),
        (str(tmp_path / 'broken'), '-v'),
    ]
    verbose, names, both, broken = (ros2_here('bag', 'info', *words) for words in calls)
    line = (
        'Service information: Service: /flip | Type: std_srvs/srv/SetBool | Request Count: 4 | '
        'Response Count: 3 | Serialization Format: cdr\n'
    )
    assert f'\nMessages:          1\nTopic information: Topic: {CHATTER} | ' in verbose.out
    assert f'\nService:           1\n{line}' in verbose.out
    assert names.out == f'{CHATTER}\n'
    assert both.out == verbose.out
    assert both.err == 'hint: with --verbose, --topic-name is ignored\n'
    assert broken.status == 1
    assert broken.err == f"'{FLIPS}' holds 8 bytes that are no event of a service\n"


def test_the_class_counts_them_as_well(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    opened_writer(tmp_path / 'empty').close()
    Info().read_metadata_and_output_service_verbose(str(tmp_path / 'empty'), '')
    assert 'Service:           0\nService information: \n' in capsys.readouterr().out


def test_a_bad_call_is_refused(
    domain: int, ros2: Callable[..., Any], ros2_here: Callable[..., Any], tmp_path: Path
) -> None:
    bad: tuple[tuple[tuple[str, ...], int, str], ...] = (
        (('info', 'broken.db3'), 1, "broken.db3' cannot be read as sqlite3"),
        (('play', 'broken.db3'), 1, "broken.db3' cannot be read as sqlite3"),
        (('info', 'broken.mcap', '-s', 'sqlite3'), 1, 'does not begin as such files do'),
        (('record', '-a', '-s', 'sqlite3', '--storage-preset-profile', 'zstd_fast'), 2, 'none of'),
        (('info', 'empty.mcap'), 1, 'it ends too soon, as where its recording was killed'),
        (('record',), 2, 'Need to specify one option'),
        (('record', '-e', '('), 2, 'is no regular expression'),
        (('record', '-a', '-o', '.'), 1, 'already exists'),
        (('info', 'nothing'), 1, "Bag path 'nothing' does not exist!"),
        (('info', 'broken.mcap'), 1, 'cannot be read as MCAP'),
        (('play', 'part/metadata.yaml'), 1, "is a part of a bag: name its folder, 'part'"),
        (('info', 'folder'), 1, 'holds no file of a bag that ends with .mcap'),
        (('play', 'broken.mcap'), 1, 'cannot be read as MCAP'),
        (('play', 'x', '-r', '-1'), 2, 'must be a number above 0'),
    )
    (tmp_path / 'broken.mcap').write_bytes(b'no bag at all')
    (tmp_path / 'broken.db3').write_bytes(b'SQLite format 3\0' + bytes(200))
    (tmp_path / 'empty.mcap').touch()
    (tmp_path / 'folder').mkdir()
    (tmp_path / 'part').mkdir()
    (tmp_path / 'part' / 'metadata.yaml').touch()
    for words, status, message in bad:
        ended = ros2_here('bag', *words)
        assert ended.status == status, (words, ended)
        assert message in ended.err, words
        assert status == 2 or ended.err.count('\n') == 1, (words, ended.err)
    answer = ros2('bag', 'info', 'nothing', folder=tmp_path)
    assert (answer.status, answer.err) == (1, "Bag path 'nothing' does not exist!\n")


def test_storages_and_compressors_are_listed_and_no_converters(
    ros2_here: Callable[..., Any],
) -> None:
    expected = {
        ('storage',): 'mcap\nsqlite3\n',
        ('storage', '-v'): 'name: sqlite3\n\tfiles *.db3, presets none, resilient\n',
        ('converter', '--verbose'): 'available converter plugins are:\n',
        ('compressor',): 'zstd\n',
        ('decompressor',): 'zstd\n',
    }
    for words, text in expected.items():
        ended = ros2_here('bag', 'list', *words)
        assert ended.status == 0, ended
        assert ended.out.endswith(text)
        assert bool(ended.out) == bool(text)
