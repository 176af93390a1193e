# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 bag play`: what of a bag is played, and how."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import math
from pathlib import Path
import signal
import time
from typing import Any

from example_interfaces.srv import AddTwoInts
from playpen_testing.bags import opened_writer, string
from playpen_testing.keyboard import CTRL_C, CTRL_Z, DOWN, Keyboard, RIGHT, UP
from playpen_testing.processes import find_line
from playpen_testing.services import ask
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from ros2bag import player
from ros2cli.node.direct import command_node
from rosbag2_interfaces.srv import (
    GetRate,
    IsPaused,
    Pause,
    PlayNext,
    Resume,
    SetRate,
    TogglePaused,
)
from rosbag2_py import TopicMetadata
from rosgraph_msgs.msg import Clock
from service_msgs.msg import ServiceEventInfo
from std_msgs.msg import String

STRING = 'std_msgs/msg/String'
EVENT = 'example_interfaces/srv/AddTwoInts_Event'
SUMS = '/add_two_ints/_service_event'
UNKNOWN = 'not_installed_msgs/msg/Strange'
UNKNOWN_EVENT = 'not_installed_msgs/srv/Strange_Event'


@pytest.fixture
def write_bag(tmp_path: Path) -> Callable[..., Path]:
    """Return a function that writes 'number N' to each topic in turn, from 0 on 10 ms apart."""

    def write(types: dict[str, str], count: int = 6) -> Path:
        writer = opened_writer(tmp_path / 'bag')
        for name, type_name in types.items():
            writer.create_topic(TopicMetadata(0, name, type_name, 'cdr'))
        for number in range(count):
            name, type_name = list(types.items())[number % len(types)]
            is_event = type_name == EVENT
            data = serialize_message(AddTwoInts.Event()) if is_event else string(number)
            writer.write(name, data, number * 10_000_000)
        writer.close()
        return tmp_path / 'bag'

    return write


def test_a_topic_of_unknown_type_or_wrong_name_is_left_out(
    write_bag: Callable[..., Path], processes: Any, ros2: Callable[..., Any]
) -> None:
    bag = write_bag({'/strange': UNKNOWN, '/chatter': STRING, '/of-ros-1': STRING})
    listener = processes.node('listener', 'listener')
    played = ros2('bag', 'play', str(bag))
    assert played.status == 0
    assert played.err.count('\n') == 3
    assert '[WARN] [' in played.err
    assert f"Playing 1 of 3 topics in '{bag}', 0.1 s long, at rate 1; Ctrl-C ends it" in played.err
    assert "Topic '/of-ros-1' is left out: '/of-ros-1' is no name of a topic: " in played.err
    assert "Topic '/strange' is left out: " in played.err
    assert "package 'not_installed_msgs' not found" in played.err
    for number in (1, 4):
        find_line(listener.stdout, f'^heard number {number}$')


def test_a_bag_of_unknown_types_is_refused(
    write_bag: Callable[..., Path], domain: int, ros2_here: Callable[..., Any]
) -> None:
    bag = write_bag({'/strange': UNKNOWN, '/stranger': UNKNOWN})
    played = ros2_here('bag', 'play', str(bag))
    assert (played.status, played.out, played.err.count('\n')) == (1, '', 1)
    assert "'/strange' is left out: " in played.err
    assert "'/stranger' is left out: " in played.err


@pytest.mark.parametrize(
    ('count', 'words'),
    [
        (0, ()),
        (6, ('--start-offset', '100')),
        (6, ('--start-offset', '10000000000', '--playback-until-sec', '1e300')),
    ],
)
def test_what_has_nothing_to_play_is_not_played_again_and_again(
    write_bag: Callable[..., Path],
    domain: int,
    ros2_here: Callable[..., Any],
    count: int,
    words: tuple[str, ...],
) -> None:
    bag = write_bag({'/chatter': STRING}, count)
    played = ros2_here('bag', 'play', str(bag), '--loop', *words)
    assert (played.status, played.err.count('\n')) == (0, 1), played.err
    told = (
        f', at rate 1, of which --start-offset {float(words[1]):g} leaves nothing; '
        if words
        else ''
    )
    assert told in played.err


def test_a_remapping_that_renames_nothing_is_told(
    write_bag: Callable[..., Path], domain: int, ros2_here: Callable[..., Any]
) -> None:
    bag = write_bag({'/chatter': STRING, '/flip/_service_event': EVENT})
    rules = ('chatter:=said', '/flip:=/flop', '/chater:=/said')
    played = ros2_here('bag', 'play', str(bag), '--remap', *rules)
    assert (played.status, played.err.count(' renames nothing')) == (0, 1), played
    told = '--remap /chater:=/said renames nothing: no such topic is played; did you mean '
    assert f"{told}'/chatter'?" in played.err


def test_a_file_sets_the_quality_of_service(
    write_bag: Callable[..., Path], processes: Any, ros2: Callable[..., Any], tmp_path: Path
) -> None:
    bag = write_bag({'/chatter': STRING})
    (tmp_path / 'qos.yaml').write_text(
        'chatter:\n'
        '  history: keep_all\n  depth: 0\n'
        '  reliability: best_effort\n  durability: transient_local\n'
        '  deadline: {sec: 1, nsec: 5}\n  lifespan: {sec: 0, nsec: 0}\n'
        '  liveliness: manual_by_topic\n  liveliness_lease_duration: {sec: 2, nsec: 0}\n'
        '  avoid_ros_namespace_conventions: false\n'
    )
    words = ('--qos-profile-overrides-path', str(tmp_path / 'qos.yaml'), '--delay', '60')
    processes.ros2('bag', 'play', str(bag), *words)
    deadline = time.monotonic() + 20.0
    while 'Node name: rosbag2_player' not in (info := ros2('topic', 'info', '-v', '/chatter').out):
        assert time.monotonic() < deadline, 'no publisher of the player within 20 s'
    for line in (
        'Reliability: BEST_EFFORT',
        'Durability: TRANSIENT_LOCAL',
        'Lifespan: Infinite',
        'Deadline: 1000000005 nanoseconds',
        'Liveliness: MANUAL_BY_TOPIC',
        'Liveliness lease duration: 2000000000 nanoseconds',
    ):
        assert f'{line}\n' in info


def test_a_bad_file_of_qualities_is_refused(
    write_bag: Callable[..., Path], domain: int, ros2_here: Callable[..., Any], tmp_path: Path
) -> None:
    (tmp_path / 'qos.yaml').write_text('/chatter: {depth: many}')
    bag = write_bag({'/chatter': STRING})
    answer = ros2_here('bag', 'play', str(bag), '--qos-profile-overrides-path', 'qos.yaml')
    assert (answer.status, answer.err.count('\n')) == (2, 1)
    assert "depth: 'many' must be a whole number" in answer.err


def test_play_ends_although_a_listener_has_stopped(
    write_bag: Callable[..., Path], processes: Any, ros2: Callable[..., Any]
) -> None:
    processes.node('listener_that_stops', 'listener')
    assert ros2('bag', 'play', str(write_bag({'/chatter': STRING}))).status == 0


def test_an_interrupt_ends_the_wait_for_a_listener(domain: int) -> None:
    class Unheard:
        qos_profile = QoSProfile(depth=1)

        def wait_for_all_acked(self, timeout: Duration) -> bool:
            assert timeout.nanoseconds < 1e9
            rclpy.shutdown()  # what rclpy does for SIGINT
            return False

    with pytest.raises(KeyboardInterrupt), command_node() as node:
        player.wait_for_acknowledgements(node, [Unheard()], None)


@pytest.fixture
def heard(domain: int) -> Iterator[list[str]]:
    """Return a list that grows by what is heard: numbers on /chatter, the names of others."""
    found: list[str] = []
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'student')
        node.create_subscription(String, '/chatter', lambda msg: found.append(msg.data[-1]), 10)
        node.create_subscription(String, '/other', lambda _: found.append('/other'), 10)
        node.create_subscription(AddTwoInts.Event, SUMS, lambda _: found.append('sum'), 10)
        yield found


def full_at_the_end(folder: Path, counts: dict[str, int]) -> tuple[str, str]:
    """
    Return options that give each topic a history for as many messages as are played.

    Fast DDS asks at once whether what fills it has arrived, and else within 3 s.
    """
    file = folder / 'full.yaml'
    file.write_text(''.join(f'{topic}: {{depth: {n}}}\n' for topic, n in counts.items()))
    return '--qos-profile-overrides-path', str(file)


@pytest.mark.parametrize(
    ('words', 'expected'),
    [
        ((), {'0', '/other', 'sum'}),
        (('--topics', '/other'), {'/other', 'sum'}),
        (('--topics', '/other', '--exclude-services', '/add_two_ints'), {'/other'}),
        (('--topics', SUMS), {'sum'}),
        (('--services', 'add_two_ints', '--exclude-topics', '/chatter'), {'/other', 'sum'}),
        (('-e', '/(other|chat.*)'), {'0', '/other'}),
        (('-e', 'other'), set()),
        (('-e', '/o.*', '--topics', 'chatter'), {'0', '/other'}),
        (('-x', '.*_event|/chatter'), {'/other'}),
    ],
)
def test_what_is_chosen_is_played(
    write_bag: Callable[..., Path],
    heard: list[str],
    ros2_here: Callable[..., Any],
    tmp_path: Path,
    words: tuple[str, ...],
    expected: set[str],
) -> None:
    types = {'/chatter': STRING, '/other': STRING, SUMS: EVENT}
    bag = write_bag(types, 3)
    full = full_at_the_end(tmp_path, dict.fromkeys(types, 1))
    played = ros2_here('bag', 'play', str(bag), *words, *full)
    assert played.status == (0 if expected else 1)
    assert ('No topic of the bag is chosen; it has ' in played.err) == (not expected)
    wait_until(lambda: set(heard) >= expected, timeout_sec=10.0, what=lambda: f'more than {heard}')
    assert set(heard) == expected


@pytest.mark.parametrize('source', [None, 'client_introspection'])
def test_recorded_requests_are_sent_again(
    tmp_path: Path, domain: int, ros2_here: Callable[..., Any], source: str | None
) -> None:
    asked: list[tuple[int, int]] = []

    def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        asked.append((request.a, request.b))
        return response

    writer = opened_writer(tmp_path / 'bag')
    writer.create_topic(TopicMetadata(0, SUMS, EVENT, 'cdr'))
    writer.create_topic(TopicMetadata(0, '/strange/_service_event', UNKNOWN_EVENT, 'cdr'))
    writer.write('/strange/_service_event', b'', 0)
    for number in range(8):  # four calls: what the client sent, what the service received
        event = AddTwoInts.Event()
        sent = (ServiceEventInfo.REQUEST_SENT, ServiceEventInfo.REQUEST_RECEIVED)
        event.info.event_type = sent[number % 2]
        if number < 6:
            event.request = [AddTwoInts.Request(a=number, b=10)]
        writer.write(SUMS, serialize_message(event), number * 10_000_000)
    writer.close()
    events: list[AddTwoInts.Event] = []
    words = ('--service-requests-source', source) if source else ()
    command = ('bag', 'play', str(tmp_path / 'bag'), '--publish-service-requests', *words)
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'adder')
        node.create_service(AddTwoInts, 'add_two_ints', add)
        node.create_subscription(AddTwoInts.Event, SUMS, events.append, 10)
        played = ros2_here(*command)
    assert (played.status, played.err.count('\n')) == (0, 3), played.err
    assert "Topic '/strange/_service_event' is left out: " in played.err
    assert "Service '/add_two_ints': the bag has only metadata of its calls" in played.err
    assert asked == [(first, 10) for first in ((0, 2, 4) if source else (1, 3, 5))]
    assert events == []


@pytest.mark.parametrize(
    ('words', 'expected'),
    [
        (('--playback-duration', '0.025'), '012'),
        (('--playback-duration', '0.015', '--start-offset', '0.02'), '23'),
        (('--playback-duration', '0'), ''),
        (('--playback-duration', '-1', '--playback-until-sec', '-1'), '012345'),
        (('--playback-until-sec', '0.03'), '0123'),
        (('--playback-until-nsec', '39999999', '--playback-duration', '0.01'), '0123'),
    ],
)
def test_play_ends_where_it_should(
    write_bag: Callable[..., Path],
    heard: list[str],
    ros2_here: Callable[..., Any],
    tmp_path: Path,
    words: tuple[str, ...],
    expected: str,
) -> None:
    bag = write_bag({'/chatter': STRING})
    words = (*words, '--read-ahead-queue-size', '1', '--disable-keyboard-controls')
    words = (*words, *full_at_the_end(tmp_path, {'/chatter': len(expected) or 1}))
    played = ros2_here('bag', 'play', str(bag), *words, '--log-level', 'warn')
    assert (played.status, played.err) == (0, '')
    wait_until(
        lambda: len(heard) >= len(expected), timeout_sec=10.0, what=lambda: f'more than {heard}'
    )
    assert ''.join(heard) == expected


def test_keys_pause_step_and_change_the_rate(
    write_bag: Callable[..., Path], heard: list[str], in_terminal: Callable[..., Keyboard]
) -> None:
    def wait_for(numbers: str) -> None:
        wait_until(
            lambda: len(heard) >= len(numbers), timeout_sec=10.0, what=lambda: f'more than {heard}'
        )
        assert ''.join(heard) == numbers

    bag = write_bag({'/chatter': STRING})
    # With jobs, as in an interactive shell, but this one leaves the settings of its terminal.
    script = f'ros2 bag play {bag} --start-paused; echo "status $?"; read line; fg; echo over'
    terminal = in_terminal('sh', '-mc', script)
    terminal.wait_for_text('CURSOR_RIGHT plays the next message while paused')
    terminal.press(RIGHT + RIGHT + UP + DOWN + DOWN + 'x')
    for rate in ('1.1', '1', '0.9'):
        terminal.wait_for_text(f'Rate {rate}\x1b')
    wait_for('01')
    assert not terminal.is_as_before()
    terminal.press(CTRL_Z)
    terminal.wait_for_text('status 1')
    assert terminal.is_as_before()
    terminal.press('\n')
    wait_until(lambda: not terminal.is_as_before(), timeout_sec=10.0, what='keys after fg')
    terminal.press(RIGHT)
    wait_for('012')
    terminal.press(' ')
    terminal.wait_for_text('Resumed')
    terminal.wait_for_text('over')
    wait_for('012345')
    assert terminal.is_as_before()


@pytest.mark.parametrize('end', [CTRL_C, signal.SIGTERM])
def test_an_interrupted_player_gives_the_terminal_back(
    write_bag: Callable[..., Path],
    domain: int,
    in_terminal: Callable[..., Keyboard],
    end: str | signal.Signals,
) -> None:
    bag = write_bag({'/chatter': STRING})
    terminal = in_terminal('ros2', 'bag', 'play', str(bag), '-p', '-d', '60')
    wait_until(lambda: not terminal.is_as_before(), timeout_sec=20.0, what='keys')
    if isinstance(end, signal.Signals):
        terminal.send_signal(end)
    else:
        terminal.press(end)
    terminal.process.wait(timeout=10.0)
    assert terminal.is_as_before()


def test_keys_are_left_alone_where_they_are_disabled(
    write_bag: Callable[..., Path], domain: int, in_terminal: Callable[..., Keyboard]
) -> None:
    bag = write_bag({'/chatter': STRING})
    words = ('--start-paused', '--disable-keyboard-controls', '--clock')
    terminal = in_terminal('ros2', 'bag', 'play', str(bag), *words)
    terminal.wait_for_text('Ctrl-C ends it\x1b')
    with SpunNodes(domain) as nodes:
        times: list[Clock] = []
        nodes.start(Node, 'student').create_subscription(Clock, '/clock', times.append, 10)
        wait_until(lambda: len(times) > 3, timeout_sec=10.0, what='the time of a paused bag')
    assert all(each == Clock() for each in times)
    assert terminal.is_as_before()


def test_services_control_what_is_played(
    write_bag: Callable[..., Path], domain: int, processes: Any
) -> None:
    bag = write_bag({'/chatter': STRING})
    heard: list[str] = []
    player = processes.ros2('bag', 'play', str(bag), '-p', ready='Playing 1 of 1')
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'student')
        node.create_subscription(String, '/chatter', lambda msg: heard.append(msg.data[-1]), 10)

        def call(kind: Any, name: str, **fields: object) -> Any:
            return ask(node, kind, f'/rosbag2_player/{name}', **fields)

        assert call(IsPaused, 'is_paused').paused
        assert call(SetRate, 'set_rate', rate=0.001).success
        for bad in (0.0, -1.0, math.inf, math.nan):
            assert not call(SetRate, 'set_rate', rate=bad).success
        assert call(GetRate, 'get_rate').rate == 0.001
        matched = node.count_publishers
        wait_until(lambda: matched('/chatter') == 1, timeout_sec=10.0, what='a publisher')
        assert call(PlayNext, 'play_next').success
        call(Resume, 'resume')
        assert not call(IsPaused, 'is_paused').paused
        assert not call(PlayNext, 'play_next').success
        call(Pause, 'pause')
        assert call(IsPaused, 'is_paused').paused
        while call(PlayNext, 'play_next').success:
            pass
        wait_until(lambda: '5' in heard, timeout_sec=10.0, what=lambda: f'more than {heard}')
        assert ''.join(heard).endswith('12345')
        call(TogglePaused, 'toggle_paused')
    assert player.wait(timeout=10.0) == 0


@pytest.mark.parametrize(
    ('words', 'expected'),
    [(('--clock-topics-all',), [0, 1, 2, 3]), (('--clock-topics', 'other'), [1, 3])],
)
def test_messages_bring_the_time_with_them(
    write_bag: Callable[..., Path],
    domain: int,
    ros2_here: Callable[..., Any],
    words: tuple[str, ...],
    expected: list[int],
) -> None:
    bag = write_bag({'/chatter': STRING, '/other': STRING}, 4)
    times: list[int] = []
    with SpunNodes(domain) as nodes:
        nodes.start(Node, 'student').create_subscription(
            Clock, '/clock', lambda msg: times.append(msg.clock.nanosec // 10_000_000), 10
        )
        assert ros2_here('bag', 'play', str(bag), *words, '--rate', '0.05').status == 0
        wait_until(
            lambda: len(times) >= len(expected), timeout_sec=10.0, what=lambda: f'more: {times}'
        )
    assert times == expected


def test_a_bad_choice_is_refused(
    write_bag: Callable[..., Path],
    domain: int,
    ros2: Callable[..., Any],
    ros2_here: Callable[..., Any],
) -> None:
    bad = {
        ('--topics', '/clock', '--clock'): 'No topic of the bag is chosen; it has /clock',
        ('--services', 'x'): "The bag has no topic '/x/_service_event'; it has /clock",
        ('-x', '('): "'(' is no regular expression",
        ('--clock-topics', '/x'): "The bag has no topic '/x'; it has /clock",
        ('--clock', '5', '--clock-topics-all'): 'not allowed with',
        ('--playback-duration', 'inf'): "'inf' is refused: it must be a number",
        ('--playback-until-sec', '1', '--playback-until-nsec', '1'): 'not allowed with',
    }
    bag = write_bag({'/clock': 'rosgraph_msgs/msg/Clock'}, 0)
    calls = [('bag', 'play', str(bag), *words) for words in bad]
    ended = [ros2_here(*call) for call in calls]
    for (words, message), each in zip(bad.items(), ended, strict=True):
        assert each.status in (1, 2), (words, each)
        assert message in each.err, words
    answer = ros2(*calls[0])
    assert (answer.status, answer.err) == (ended[0].status, ended[0].err)
