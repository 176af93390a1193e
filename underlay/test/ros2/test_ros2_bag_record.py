# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 bag record`: which topics and services are recorded, and into what."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from pathlib import Path
import signal
import sqlite3
import sys
import time
from typing import Any

from builtin_interfaces.msg import Time
from playpen_testing.bags import opened_reader
from playpen_testing.keyboard import CTRL_C, Keyboard
from playpen_testing.services import ask
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import serialize_message
from ros2bag.recorder import Recorder
from ros2cli.discovery import read_graph
from ros2cli.node.direct import command_node
from rosbag2_interfaces.msg import WriteSplitEvent
from rosbag2_interfaces.srv import IsPaused, Pause, Resume, Snapshot, SplitBagfile
from rosbag2_py.bag_writer import BagWriter
from rosbag2_py.selection import EVENTS, Selection
from rosbag2_py.storages import STORAGES
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

CHATTER, FLIPS, SUMS = '/chatter', '/flip/_service_event', '/add_two_ints/_service_event'
WITHOUT_EFFECT = (
    *('--max-cache-size', '0', '--disable-keyboard-controls', '--compression-mode', 'none'),
    *('--compression-queue-size', '1', '--compression-threads', '2'),
    *('--compression-threads-priority', '-5'),
)


class Recording:
    """`ros2 bag record` into sqlite3, where all that is recorded can be counted at once."""

    def __init__(
        self, processes: Any, folder: Path, *words: str, ready: str = 'Recording...'
    ) -> None:
        self.bag = folder / 'bag'
        self._process = processes.ros2(
            *('bag', 'record', '-s', 'sqlite3', '-o', str(self.bag), *words), ready=ready
        )

    def wait_for(self, *topics: str, count: int = 1) -> None:
        deadline = time.monotonic() + 20.0
        while missing := [each for each in topics if self.count(each) < count]:
            assert time.monotonic() < deadline, f'not recorded within 20 s: {missing}'
            time.sleep(0.05)

    def end(self) -> set[str]:
        """Interrupt it; return the names of what was recorded."""
        self._process.send_signal(signal.SIGINT)
        rest, _ = self._process.communicate(timeout=10)
        assert 'Recording stopped: ' in rest
        return {each.name for each in opened_reader(self.bag).get_all_topics_and_types()}

    def count(self, topic: str) -> int:
        query = (
            'SELECT COUNT(*) FROM messages WHERE topic_id = (SELECT id FROM topics WHERE name=?)'
        )
        number = 0
        for file in self.bag.glob('*.db3'):
            with closing(sqlite3.connect(f'{file.as_uri()}?mode=ro', uri=True)) as opened:
                number += int(opened.execute(query, (topic,)).fetchone()[0])
        return number


@pytest.fixture(scope='module')
def graph(shared_processes: Any) -> Any:
    """Let two services tell of their calls, and a node talk; return where processes start."""
    shared_processes.start(
        *(sys.executable, '-m', 'demo_nodes_py.services.introspection', '--ros-args'),
        *('-p', 'client_configure_introspection:=contents'),
        *('-p', 'service_configure_introspection:=contents'),
        ready='Result of add_two_ints: 5',
    )
    shared_processes.node('talker', 'talker')
    shared_processes.node('service', 'server')
    # What it tells of a call is kept for who comes later.
    shared_processes.ros2('service', 'call', '/flip', 'std_srvs/srv/SetBool', ready='flipped')
    return shared_processes


@pytest.mark.parametrize(
    ('words', 'expected'),
    [
        ((SUMS,), {SUMS}),
        (('--service', 'add_two_ints'), {SUMS}),
        ((CHATTER, '--services', '/flip', '/add_two_ints'), {CHATTER, FLIPS, SUMS}),
        (('--all-services', '--exclude-services', '/flip'), {SUMS}),
        (('--all-services', '--exclude-regex', 'add'), {FLIPS}),
        (('-a',), {CHATTER, FLIPS, SUMS}),
        (('--all-topics',), {CHATTER}),
        (('-e', 'flip|chat'), {CHATTER, FLIPS}),
        (('--topic-types', 'std_msgs/msg/String', 'x/msg/Y'), {CHATTER}),
        (('-a', '--exclude-topic-types', 'std_msgs/msg/String'), {FLIPS, SUMS}),
        (('-a', '--exclude-topics', 'chatter', '--exclude-services', 'flip'), {SUMS}),
        (('--all-topics', *WITHOUT_EFFECT), {CHATTER}),
    ],
)
def test_what_is_chosen_is_recorded(
    graph: Any, tmp_path: Path, words: tuple[str, ...], expected: set[str]
) -> None:
    recording = Recording(graph, tmp_path, *words)
    recording.wait_for(*expected)
    assert recording.end() & {CHATTER, FLIPS, SUMS} == expected


@pytest.mark.parametrize(
    ('words', 'told'),
    [
        (('-a', '-e', 'flip'), '--all records everything: --regex beside it leaves none out; to'),
        (('--all-topics', CHATTER), '--all-topics records every topic: --topics beside it leaves'),
        (('-a', '--services', '/flip'), '--all records everything: --services beside it leaves'),
    ],
)
def test_a_choice_beside_everything_is_told(
    processes: Any, tmp_path: Path, words: tuple[str, ...], told: str
) -> None:
    Recording(processes, tmp_path, *words, ready=told).end()


def test_it_counts_who_else_uses_a_topic(graph: Any, shared_domain: int, tmp_path: Path) -> None:
    with SpunNodes(shared_domain) as nodes:
        node = nodes.start(Node, 'student')
        node.create_subscription(String, '/wanted', lambda _: None, 10)

        def is_heard_by_tape() -> bool:
            found = node.get_subscriptions_info_by_topic('/wanted')
            return 'tape' in {each.node_name for each in found}

        words = ('--include-unpublished-topics', '--node-name', 'tape', '-f', 'cdr')
        recording = Recording(graph, tmp_path / 'unpublished', '--all-topics', *words)
        wait_until(is_heard_by_tape, timeout_sec=10.0, what='a subscription of the recorder')
        publisher = node.create_publisher(String, '/wanted', 10)
        node.create_timer(0.05, lambda: publisher.publish(String(data='here')))
        recording.wait_for('/wanted', CHATTER)
        recording.end()
        recording = Recording(graph, tmp_path / 'leaf', '--all-topics', '--ignore-leaf-topics')
        recording.wait_for('/wanted')
    assert CHATTER not in recording.end()


@pytest.mark.parametrize(
    'words', [('-d', '1', '--compression-mode', 'file'), ('-s', 'mcap', '--max-bag-size', '2000')]
)
def test_a_limit_begins_new_files(processes: Any, tmp_path: Path, words: tuple[str, ...]) -> None:
    # MCAP is written by the megabyte.
    publish = ('topic', 'pub', '-r', '40', '--print', '1000000', '/large', 'std_msgs/msg/String')
    processes.ros2(*publish, f'data: {"x" * 50_000}')
    recording = Recording(processes, tmp_path, '/large', *words)
    deadline = time.monotonic() + 20.0
    while len({file.name.partition('.')[0] for file in recording.bag.glob('bag_*')}) < 3:
        assert time.monotonic() < deadline, 'not three files within 20 s'
        time.sleep(0.05)
    assert recording.end() == {'/large'}
    files = opened_reader(recording.bag).get_metadata().files
    assert len(files) >= 3
    assert all(file.message_count > 1 for file in files[:2])
    assert {file.path.endswith('.zstd') for file in files} == {'--compression-mode' in words}


def test_services_pause_a_recording_and_begin_a_new_file(
    graph: Any, shared_domain: int, tmp_path: Path
) -> None:
    recording = Recording(graph, tmp_path, CHATTER, '--start-paused')
    heard: list[String] = []
    with SpunNodes(shared_domain) as nodes:
        node = nodes.start(Node, 'student')

        def call(kind: Any, name: str) -> Any:
            return ask(node, kind, f'/rosbag2_recorder/{name}')

        assert call(IsPaused, 'is_paused').paused
        node.create_subscription(String, CHATTER, heard.append, 10)
        wait_until(lambda: len(heard) > 4, timeout_sec=10.0, what='a talker')
        assert recording.count(CHATTER) == 0
        call(Resume, 'resume')
        recording.wait_for(CHATTER)
        call(SplitBagfile, 'split_bagfile')
        call(Pause, 'pause')
        assert call(IsPaused, 'is_paused').paused
    assert recording.end() == {CHATTER}
    assert len(opened_reader(recording.bag).get_metadata().files) == 2


def test_a_snapshot_has_the_last_messages(graph: Any, shared_domain: int, tmp_path: Path) -> None:
    size = len(serialize_message(String(data='Hello World: 10')))
    words = (CHATTER, '--snapshot-mode', '--max-cache-size', str(2 * size + 3))
    ready = 'a snapshot is asked for: `ros2 service call /tape/snapshot rosbag2_interfaces/srv/S'
    recording = Recording(graph, tmp_path, *words, '--node-name', 'tape', ready=ready)
    heard: list[String] = []
    with SpunNodes(shared_domain) as nodes:
        node = nodes.start(Node, 'student')
        node.create_subscription(String, CHATTER, heard.append, 10)
        wait_until(lambda: len(heard) > 4, timeout_sec=20.0, what='a talker')
        assert recording.count(CHATTER) == 0
        assert ask(node, Snapshot, '/tape/snapshot').success
    recording.wait_for(CHATTER, count=2)
    assert recording.end() == {CHATTER}
    assert recording.count(CHATTER) == 2  # what came since is lost


def test_files_that_are_complete_are_told(processes: Any, domain: int, tmp_path: Path) -> None:
    events: list[WriteSplitEvent] = []
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'student')
        node.create_subscription(WriteSplitEvent, '/events/write_split', events.append, 10)
        recording = Recording(processes, tmp_path, '-a')
        wait_until(
            lambda: node.count_publishers('/events/write_split') == 1,
            timeout_sec=10.0,
            what='a recorder',
        )
        ask(node, SplitBagfile, '/rosbag2_recorder/split_bagfile')
        wait_until(lambda: len(events) == 1, timeout_sec=10.0, what='an event')
        assert '/events/write_split' in recording.end()  # as everything
        wait_until(lambda: len(events) == 2, timeout_sec=10.0, what='an event at the end')
    first, second = (str(recording.bag / f'bag_{number}.db3') for number in range(2))
    told = [(event.closed_file, event.opened_file) for event in events]
    assert told == [(first, second), (second, '')]
    assert {event.node_name for event in events} == {'/rosbag2_recorder'}


def test_space_pauses_a_recording(
    domain: int, in_terminal: Callable[..., Keyboard], tmp_path: Path
) -> None:
    words = ('-o', str(tmp_path / 'bag'), '-a', '--start-paused')
    terminal = in_terminal('ros2', 'bag', 'record', *words)
    terminal.wait_for_text('Recording... (paused); SPACE pauses and resumes')
    wait_until(lambda: not terminal.is_as_before(), timeout_sec=10.0, what='keys')
    terminal.press('  ')
    for text in ('Resumed', 'Paused'):
        terminal.wait_for_text(text)
    terminal.press(CTRL_C)
    terminal.wait_for_text('Recording stopped: 0 messages')
    terminal.process.wait(timeout=10.0)
    assert terminal.is_as_before()


def test_simulated_time_begins_before_a_recording(
    processes: Any, domain: int, tmp_path: Path
) -> None:
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'simulator')
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_publisher(String, CHATTER, latched).publish(String(data='here'))
        words = ('--use-sim-time', CHATTER)
        recording = Recording(processes, tmp_path, *words, ready='Waiting for /clock')
        publisher = node.create_publisher(Clock, '/clock', 10)
        now = Clock(clock=Time(sec=1000))
        node.create_timer(0.05, lambda: publisher.publish(now))
        recording.wait_for(CHATTER)
        recording.end()
    bag = opened_reader(recording.bag).get_metadata()
    assert (bag.starting_time.nanoseconds, bag.duration.nanoseconds) == (1000 * 10**9, 0)


def test_custom_data_is_kept(graph: Any, tmp_path: Path) -> None:
    recording = Recording(graph, tmp_path, CHATTER, '--custom-data', 'robot=husky', 'sum=1+1=2')
    recording.end()
    kept = opened_reader(recording.bag).get_metadata().custom_data
    assert kept == {'robot': 'husky', 'sum': '1+1=2'}


def test_what_has_no_effect_is_said(ros2_here: Callable[..., Any]) -> None:
    for verb, count in (('record', 3), ('play', 3), ('burst', 2)):
        text = ' '.join(ros2_here('bag', verb, '--help').out.split())
        assert text.count('Accepted, and without effect here.') == count


def test_the_definition_of_a_service_is_kept(graph: Any, tmp_path: Path) -> None:
    recording = Recording(graph, tmp_path, SUMS)
    recording.wait_for(SUMS, count=4)
    recording.end()
    (definition,) = opened_reader(recording.bag).get_all_message_definitions()
    assert 'int64 sum' in definition.encoded_message_definition


def test_a_service_that_does_not_tell_is_waited_for(processes: Any, tmp_path: Path) -> None:
    words = ('bag', 'record', '-o', str(tmp_path / 'bag'), '--services', '/mute')
    processes.ros2(*words, ready=f'Waiting for /mute{EVENTS}; a service tells of its calls only')


def test_a_topic_that_is_misspelt_is_told_from_one_to_come(processes: Any, tmp_path: Path) -> None:
    processes.node('talker', 'talker')
    words = ('bag', 'record', '-o', str(tmp_path / 'bag'), '--topics', '/chater', '/later')
    processes.ros2(*words, ready="Waiting for /chater, /later; did you mean '/chatter'?")


def test_recording_says_that_nothing_is_chosen(processes: Any, tmp_path: Path) -> None:
    words = ('bag', 'record', '-e', 'sensors/.*', '-o', str(tmp_path / 'bag'))
    processes.ros2(*words, ready='Waiting: nothing that is there is chosen; `ros2 topic list`')


def test_a_topic_that_has_only_subscriptions_is_told(processes: Any, tmp_path: Path) -> None:
    processes.node('listener', 'listener')
    words = ('bag', 'record', '-o', str(tmp_path / 'bag'), '--topics', CHATTER)
    processes.ros2(*words, ready=f'Waiting for {CHATTER}; nobody publishes {CHATTER} yet')


def test_the_graph_is_worth_reading_while_a_wanted_topic_is_new(
    domain: int, tmp_path: Path
) -> None:
    wanted = Selection()
    wanted.topics = [CHATTER]
    with (
        SpunNodes(domain) as nodes,
        BagWriter(tmp_path / 'bag', STORAGES['mcap']) as writer,
        command_node(name='tape') as node,
    ):
        recorder = Recorder(node, writer, wanted, {})
        student = nodes.start(Node, 'student')
        student.create_publisher(String, '/other', 10)
        student.create_subscription(String, CHATTER, lambda _: None, 10)
        seen = node.node.count_subscribers
        wait_until(lambda: seen(CHATTER) == 1, timeout_sec=10.0, what='a subscription')
        assert not recorder.knows_new_topics()  # nobody publishes it
        student.create_publisher(String, CHATTER, 10)
        wait_until(recorder.knows_new_topics, timeout_sec=10.0, what='a publisher')
        recorder.subscribe_to_new_topics(read_graph(quiet=True))
        assert not recorder.knows_new_topics()
    (topic,) = opened_reader(tmp_path / 'bag').get_all_topics_and_types()
    assert topic.name == CHATTER


def test_a_wrong_value_is_refused(ros2_here: Callable[..., Any]) -> None:
    bad = {
        ('--custom-data', 'husky'): "'husky' is no KEY=VALUE",
        ('--node-name', '1 tape'): "'1 tape' is no name of a node: letters, digits and _, ",
        ('--log-level', 'loud'): "invalid choice: 'loud'",
        ('--compression-mode', 'all'): "invalid choice: 'all'",
        ('-f', 'json'): "invalid choice: 'json'",
    }
    for words, message in bad.items():
        answer = ros2_here('bag', 'record', '-a', *words)
        assert answer.status == 2
        assert message in answer.err


def test_a_file_sets_the_quality_of_service(
    processes: Any, ros2: Callable[..., Any], tmp_path: Path
) -> None:
    processes.node('talker', 'talker')
    (tmp_path / 'qos.yaml').write_text('/chatter: {reliability: best_effort, history: keep_all}')
    words = ('-a', '--qos-profile-overrides-path', str(tmp_path / 'qos.yaml'))
    recording = Recording(processes, tmp_path, *words)
    recording.wait_for(CHATTER)
    _, subscription = ros2('topic', 'info', '-v', CHATTER).out.split('Node name: rosbag2_recorder')
    assert 'Reliability: BEST_EFFORT\n' in subscription
    assert recording.end() >= {CHATTER}


def test_a_bad_file_of_qualities_is_refused(
    domain: int, ros2: Callable[..., Any], ros2_here: Callable[..., Any], tmp_path: Path
) -> None:
    bad = {
        '': 'names no topic: write /topic: {depth: 10}',
        '/chatter: {': 'is no YAML: ',
        '/chatter: reliable': "/chatter: 'reliable' is no dictionary of history, ",
        '/chatter: {reliabilty: reliable}': '/chatter: there is no reliabilty; there are his',
        '/chatter: {history: keep_some}': "history: 'keep_some' must be one of system_default,",
        '/chatter: {liveliness: unknown}': "liveliness: 'unknown' must be one of ",
        '/chatter: {depth: -1}': 'depth: -1 must be a whole number from 0 to 2147483647',
        '/chatter: {depth: 0}': 'depth: 0 keeps no message',
        '/chatter: {deadline: {sec: 2}}': "{'sec': 2} must have both, as {sec: 1, nsec: 0}",
        '/chatter: {lifespan: {sec: -2, nsec: 0}}': 'lifespan: sec: -2 must be a whole number',
        '/chatter: {avoid_ros_namespace_conventions: 1}': '1 must be true or false',
    }
    words = ('bag', 'record', '-a', '--qos-profile-overrides-path')
    for number, text in enumerate(bad):
        (tmp_path / f'qos{number}.yaml').write_text(text)
    calls = [(*words, f'qos{number}.yaml') for number in range(len(bad))]
    ended = [ros2_here(*call) for call in calls]
    for call, (text, message), each in zip(calls, bad.items(), ended, strict=True):
        assert (each.status, each.err.count('\n')) == (2, 1), (text, each)
        assert f"--qos-profile-overrides-path '{call[-1]}'" in each.err, text
        assert message in each.err, text
    answer = ros2(*calls[0])
    assert (answer.status, answer.err) == (2, ended[0].err)


def test_options_that_make_no_sense_are_refused(
    domain: int, ros2: Callable[..., Any], ros2_here: Callable[..., Any], tmp_path: Path
) -> None:
    bad = {
        (CHATTER, '--exclude-regex', 'x'): '--exclude-regex goes with one of --all, ',
        ('--all-services', '--exclude-topics', CHATTER): '--exclude-topics goes with one of',
        (CHATTER, '--exclude-topic-types', 'x'): '--exclude-topic-types goes with one of',
        ('--all-topics', '--exclude-services', '/flip'): '--exclude-services goes with one of',
        ('-a', '--qos-profile-overrides-path', 'none'): "'none' cannot be read: No such file",
        ('-a', '--compression-format', 'zstd'): 'needs a --compression-mode: file or message',
        ('-a', '--snapshot-mode', '--max-cache-size', '0'): 'needs a --max-cache-size',
        ('-a', '--storage-config-file', 'x'): 'here: it is for plugins in C++; --storage-preset',
        ('-a', '-b', '1023'): '--max-bag-size 1023: it is 1024 bytes at least for mcap',
        ('-a', '--use-sim-time', '--no-discovery'): 'not --no-discovery',
    }
    calls = [('bag', 'record', '-o', 'bag', *words) for words in bad]
    ended = [ros2_here(*call) for call in calls]
    for (words, message), each in zip(bad.items(), ended, strict=True):
        assert (each.status, each.err.count('\n')) == (2, 1), (words, each)
        assert message in each.err, words
    answer = ros2(*calls[0])
    assert (answer.status, answer.err) == (2, ended[0].err)
    assert not (tmp_path / 'bag').exists()
