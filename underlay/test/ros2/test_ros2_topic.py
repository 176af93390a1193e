# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The verbs of `ros2 topic` that take part in the graph."""

from __future__ import annotations

import argparse
from array import array
from collections.abc import Callable
import math
import re
import signal
import sys
import threading
import time
from types import SimpleNamespace
from typing import Any

from playpen_testing.forks import run_forked
from playpen_testing.processes import find_line
from playpen_testing.shared_memory import left, own_files, without_common_ports
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, ReliabilityPolicy
from ros2cli import discovery
from ros2cli.node.direct import command_node
from ros2topic import printing, qos, silence
from rosgraph_msgs.msg import Clock
from rtps_graph.graph import Endpoint, Graph, Qos, Role
from rtps_graph.graph import Node as GraphNode
from rtps_graph.names import COMMAND_NODE
from std_msgs.msg import String


@pytest.fixture(scope='module')
def world(shared_processes: Any) -> Any:
    shared_processes.node('talker', 'talker')
    shared_processes.node('latched', 'latched')
    shared_processes.node('stamped', 'stamped')
    shared_processes.node('widest', 'widest')
    return shared_processes


@pytest.mark.usefixtures('world')
def test_echo_prints_messages_as_yaml(ros2: Callable[..., Any]) -> None:
    answer = ros2('topic', 'echo', '/chatter', '--once')
    first, last = answer.lines
    assert first.startswith('data: hello ')
    assert (last, answer.status) == ('---', 0)


@pytest.mark.usefixtures('world')
def test_echo_hears_what_was_said_before_it_came(ros2_here: Callable[..., Any]) -> None:
    assert ros2_here('topic', 'echo', '--once', '/latched').lines == ['data: once', '---']


@pytest.mark.usefixtures('world')
@pytest.mark.parametrize('kind', [[], ['std_msgs/msg/Float32']])
def test_echo_shows_the_largest_float32(ros2: Callable[..., Any], kind: list[str]) -> None:
    answer = ros2('topic', 'echo', '--once', '/widest', *kind)
    assert answer.lines == ['data: 3.4028234663852886e+38', '---']


@pytest.mark.usefixtures('world')
def test_echo_shows_a_field_or_a_line(ros2_here: Callable[..., Any]) -> None:
    field = ros2_here('topic', 'echo', '--once', '/stamped', '--field', 'twist.linear')
    assert field.lines == ['x: 1.5', 'y: 0.0', 'z: 0.0', '---']
    line = ros2_here('topic', 'echo', '--once', '--csv', '/stamped')
    assert line.out.endswith(',,1.5,0.0,0.0,0.0,0.0,0.0\n')


def test_a_field_is_cut_only_where_a_length_is_given(capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser()
    printing.add_arguments(parser)

    def shown(value: Any, *words: str) -> str:
        printing.show(value, parser.parse_args(words))
        return capsys.readouterr().out

    text, numbers = 'a' * 200, array('h', range(200))
    assert shown(text) == shown(text, '-f', '-l', '3') == f'{text}\n---\n'
    assert shown(numbers) == f'{numbers}\n---\n'
    assert shown(text, '-l', '3') == 'aaa...\n---\n'
    assert shown(String(data=text)) == f'data: {text[:128]}...\n---\n'
    assert shown(String(data=text), '-f') == f'data: {text}\n---\n'


def test_echo_says_where_publishers_offer_different_things(
    capsys: pytest.CaptureFixture[str],
) -> None:
    parser = argparse.ArgumentParser()
    qos.add_qos_arguments(parser, 'subscribe', 'sensor_data')

    def offers(*, reliable: bool, transient_local: bool) -> Endpoint:
        offered = Qos(reliable, transient_local, None, None, False, None)
        return Endpoint(b'1', Role.PUBLISHER, '/tf_static', 'tf2_msgs/msg/TFMessage', '', offered)

    latched = offers(reliable=True, transient_local=True)
    unlike = offers(reliable=False, transient_local=False)
    for publishers in ([latched, latched], [unlike, unlike]):
        qos.profile_for(parser.parse_args([]), publishers)
    qos.profile_for(parser.parse_args(['--qos-depth', '9']), [latched, unlike])
    assert capsys.readouterr().err == ''
    chosen = qos.profile_for(parser.parse_args([]), [latched, unlike])
    assert chosen.reliability == ReliabilityPolicy.BEST_EFFORT
    assert chosen.durability == DurabilityPolicy.VOLATILE
    assert capsys.readouterr().err.splitlines() == [
        'hint: not all publishers are RELIABLE, so that echo asks for BEST_EFFORT, which fits all',
        'hint: not all publishers are TRANSIENT_LOCAL, so that echo asks for VOLATILE, which fits '
        'all but brings nothing that was published before; --qos-reliability reliable '
        '--qos-durability transient_local does',
    ]


def test_the_best_available_is_what_all_publishers_offer() -> None:
    parser = argparse.ArgumentParser()
    qos.add_qos_arguments(parser, 'subscribe', 'sensor_data')

    def offers(most: bool) -> Endpoint:
        offered = Qos(most, most, None, None, most, None)
        return Endpoint(b'1', Role.PUBLISHER, '/chatter', 'std_msgs/msg/String', '', offered)

    least = (ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE, LivelinessPolicy.AUTOMATIC)
    most = (
        ReliabilityPolicy.RELIABLE,
        DurabilityPolicy.TRANSIENT_LOCAL,
        LivelinessPolicy.MANUAL_BY_TOPIC,
    )
    preset = ['--qos-profile', 'best_available']
    each = [f'--qos-{name}=best_available' for name in ('reliability', 'durability', 'liveliness')]
    for words in (preset, [*preset, '--qos-depth', '9'], each):
        for other, expected in ((True, most), (False, least)):
            publishers = [offers(True), offers(other)]
            chosen = qos.profile_for(parser.parse_args(words), publishers)
            assert (chosen.reliability, chosen.durability, chosen.liveliness) == expected


@pytest.mark.usefixtures('world')
def test_echo_filters(ros2_here: Callable[..., Any]) -> None:
    answer = ros2_here('topic', 'echo', '--once', '/chatter', '--filter', "m.data.endswith('0')")
    assert answer.lines[0].endswith('0')


@pytest.mark.usefixtures('world')
def test_echo_shows_raw_bytes(ros2_here: Callable[..., Any]) -> None:
    assert b'once' in eval(ros2_here('topic', 'echo', '--raw', '--once', '/latched').lines[0])


@pytest.mark.usefixtures('world')
def test_what_echo_filters_are_the_bytes_with_raw(ros2_here: Callable[..., Any]) -> None:
    words = ('topic', 'echo', '--raw', '/latched', '--filter')
    assert "b'" in ros2_here(*words, "b'once' in m", '--once').out
    assert ros2_here(*words, "b'once' not in m", '--timeout', '2').out == ''


def test_a_depth_of_0_is_that_of_the_preset() -> None:
    assert qos.qos_profile_from_short_keys('sensor_data', depth=0).depth == 5
    assert qos.qos_profile_from_short_keys('sensor_data', depth=7).depth == 7


@pytest.mark.usefixtures('world')
def test_echo_ends_quietly_at_its_timeout(ros2_here: Callable[..., Any]) -> None:
    answer = ros2_here('topic', 'echo', '/silence', 'std_msgs/msg/String', '--timeout', '0.3')
    assert (answer.status, answer.out, answer.err) == (0, '', '')


@pytest.mark.usefixtures('world')
def test_echo_names_what_it_refuses(ros2: Callable[..., Any]) -> None:
    bad = {
        ('/nothing',): 'Could not determine the type for the passed topic',
        ('/chater',): "did you mean '/chatter'?",
        ('/chatter', 'std_msgs/msg/Strin'): "has no message 'Strin'; did you mean 'String'",
        ('/chatter', 'std_msgs/mgs/String'): "is no message; did you mean 'std_msgs/msg/String'?",
        ('/chatter', 'nothing_msgs/msg/A'): "package 'nothing_msgs' not found",
        ('/chatter', 'x'): 'as std_msgs/msg/String',
        ('/a//b',): "'/a//b' is no valid topic name",
        ('/latched', '--field', 'datum'): "has no attribute 'datum'; there is data",
        ('/latched', '--filter', 'm.x ='): "Invalid expression 'm.x ='",
        ('/latched', '--filter', 'm.x'): "--filter 'm.x' fails",
    }
    calls = [('ros2cli.cli', 'topic', 'echo', *words) for words in bad]
    preload = ('ros2topic.verb.echo', 'rclpy')
    for (words, message), ended in zip(
        bad.items(), run_forked(*calls, preload=preload), strict=True
    ):
        assert ended.status in (1, 2), (words, ended)
        assert message in ended.err, words
    answer = ros2('topic', 'echo', '/latched', '--filter', 'm.x')
    assert (answer.status, "--filter 'm.x' fails" in answer.err) == (1, True)


def test_hz_measures_the_rate(world: Any) -> None:
    process = world.ros2('topic', 'hz', '/chatter')
    rates = []
    for line in process.stdout:
        if line.startswith('average rate: '):
            rates.append(float(line.split()[-1]))
            # A busy machine delivers the first messages in a burst, which the mean outweighs.
            if rates[-1] == pytest.approx(20.0, rel=0.2) or len(rates) == 10:
                break
    assert rates[-1] == pytest.approx(20.0, rel=0.2), rates
    find_line(process.stdout, 'window: ')
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=5)
    assert process.returncode == signal.SIGINT


def test_hz_says_what_was_meant_by_a_topic_that_is_not_there(world: Any) -> None:
    process = world.ros2('topic', 'hz', '/chater')
    hint = find_line(process.stdout, '^hint: (.*)')[1]
    assert hint == "nobody uses '/chater'; did you mean '/chatter'?"


def test_hz_tells_of_a_filter_that_lets_nothing_pass(world: Any) -> None:
    process = world.ros2('topic', 'hz', '/chatter', '--filter', "m.data == ''")
    hint = find_line(process.stdout, '^hint: (.*)')[1]
    assert re.fullmatch(r'/chatter: the filter let none of \d+ messages pass', hint)


def test_a_topic_is_listened_to_while_the_hint_is_looked_for(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    listening = threading.Event()

    class Silent:
        node = SimpleNamespace(get_publishers_info_by_topic=lambda _: [])

        def spin_until(self, done: Callable[[], bool], timeout_sec: float | None = None) -> bool:
            if timeout_sec is None:
                listening.set()
                wait_until(done, timeout_sec=5.0, what='the graph')
            return False

    def read_graph(*, quiet: bool) -> Graph:
        assert listening.wait(5.0), 'what comes meanwhile is missed'
        return Graph([], [])

    monkeypatch.setattr(discovery, 'read_graph', read_graph)
    node: Any = Silent()
    silence.hint_when_silent(node, '/silence', listening.is_set)
    assert capsys.readouterr().err == ''  # something has come after all
    silence.hint_when_silent(node, '/silence', lambda: False)
    assert capsys.readouterr().err.startswith('hint: /silence: nobody publishes it; ')


@pytest.mark.parametrize(('sent_at_sec', 'told_at_sec'), [(3.0, math.inf), (9.0, 3.5)])
def test_a_publisher_that_has_just_begun_is_not_called_silent(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    sent_at_sec: float,
    told_at_sec: float,
) -> None:
    now_sec = 0.0
    offered = Qos(True, False, None, None, False, None)
    late = Endpoint(b'1', Role.PUBLISHER, '/silence', 'std_msgs/msg/String', '', offered)

    def publishers(_: str) -> list[Any]:
        return [SimpleNamespace(endpoint_gid=[1])] if now_sec >= 1.5 else []

    class Listener:
        node = SimpleNamespace(get_publishers_info_by_topic=publishers)

        def spin_until(self, done: Callable[[], bool], timeout_sec: float = math.inf) -> bool:
            nonlocal now_sec
            end_sec = now_sec + timeout_sec
            while not (is_done := done()) and now_sec < end_sec:
                time.sleep(0.0)  # the thread that reads the graph comes to its turn
                now_sec += 0.125 if timeout_sec < math.inf else 0.0
            return is_done

    def read_graph(*, quiet: bool) -> Graph:
        return Graph([GraphNode('late', '/', [late])], [late])

    monkeypatch.setattr(discovery, 'read_graph', read_graph)
    monkeypatch.setattr(silence, 'time', SimpleNamespace(monotonic=lambda: now_sec))
    listener: Any = Listener()
    silence.hint_when_silent(listener, '/silence', lambda: now_sec >= sent_at_sec)
    told = capsys.readouterr().err
    assert ('/late has sent nothing for 2 s' in told) == (told_at_sec < math.inf)
    assert now_sec >= min(sent_at_sec, told_at_sec)


@pytest.mark.parametrize('asked', [True, False])
def test_what_was_sent_before_is_told_to_be_kept(asked: bool) -> None:
    def endpoint(key: bytes, role: Role, transient_local: bool) -> Endpoint:
        qos = Qos(True, transient_local, None, None, False, None)
        return Endpoint(key, role, '/map', 'std_msgs/msg/String', '', qos)

    offers = endpoint(b'1', Role.PUBLISHER, True)
    command = endpoint(b'2', Role.SUBSCRIPTION, asked)
    other = endpoint(b'3', Role.SUBSCRIPTION, not asked)
    graph = Graph(
        [
            GraphNode('server', '/', [offers]),
            GraphNode(f'{COMMAND_NODE}1', '/', [command]),
            GraphNode('other', '/', [other]),
        ],
        [offers, command, other],
    )
    (told,) = silence.why_silent(graph, '/map', 2.0)
    assert str(told).startswith('/map: /server has sent nothing for 2 s')
    remedy = '`ros2 topic echo /map --qos-durability transient_local` does'
    assert str(told).endswith(remedy) == (not asked), told


def test_bw_and_delay_measure_too(world: Any) -> None:
    bandwidth = world.ros2('topic', 'bw', '/chatter', ready='messages')
    delay = world.ros2('topic', 'delay', '/stamped', ready='average delay: 0.0')
    for process in (bandwidth, delay):
        process.send_signal(signal.SIGINT)
        rest, _ = process.communicate(timeout=5)
        assert 'Traceback' not in rest


def test_delay_says_when_nothing_new_comes(processes: Any) -> None:
    sender = processes.node('stamped', 'sender')
    delay = processes.ros2('topic', 'delay', '/stamped', ready='average delay: 0.0')
    processes.end_one(sender)
    find_line(delay.stdout, '^no new messages$')


def test_delay_says_that_stamps_are_of_another_clock(processes: Any) -> None:
    def told(hint: str, *words: str) -> None:
        delay = processes.ros2('topic', 'delay', *words, ready=f'hint: {hint}')
        processes.end_one(delay)

    processes.start(sys.executable, '-m', 'husky_sim.ros.node', ready='x real time')
    processes.node('stamped', 'sender')
    processes.node('unstamped', 'forgetful')
    told('its stamps are of the time of /clock: --use-sim-time', '/odometry/filtered')
    told('its stamps are not of the time of /clock: leave out', '/stamped', '--use-sim-time')
    told('its header.stamp is 0: set it to `get_clock().now().to_msg()`', '/unstamped')


@pytest.mark.usefixtures('world')
def test_delay_needs_a_header(ros2_here: Callable[..., Any]) -> None:
    assert ros2_here('topic', 'delay', '/chatter').err == 'msg does not have header\n'


def test_a_message_published_once_arrives(processes: Any, ros2: Callable[..., Any]) -> None:
    listener = processes.node('listener', 'listener')
    words = ('topic', 'pub', '--once', '--stdin', '/chatter', 'std_msgs/msg/String')
    answer = ros2(*words, text='data: good day')
    assert answer.status == 0
    assert answer.lines[-2:] == [
        "publishing #1: std_msgs.msg.String(data='good day')",
        '',
    ]
    find_line(listener.stdout, '^heard good day$')


def test_a_subscriber_that_pub_waited_for_hears_it(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    words = ('pub', '--once', '/late', 'std_msgs/msg/String', 'data: good day')
    processes.ros2('topic', *words, ready='Waiting for at least 1')
    answer = ros2_here('topic', 'echo', '--once', '/late', 'std_msgs/msg/String')
    assert answer.lines == ['data: good day', '---']


def test_pub_ends_although_a_subscriber_has_stopped(
    processes: Any, ros2: Callable[..., Any]
) -> None:
    processes.node('listener_that_stops', 'listener')
    assert ros2('topic', 'pub', '-t', '2', '/chatter', 'std_msgs/msg/String').status == 0


def test_a_topic_without_subscribers_is_given_up(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('robot', 'robot')
    words = ('/robot/cmd_vel', 'geometry_msgs/msg/Twist', '--max-wait-time-secs', '0.1')
    answer = ros2_here('topic', 'pub', '--once', *words)
    assert answer.status == 1
    assert answer.lines == ['Waiting for at least 1 matching subscription(s)...'] * 2
    assert answer.err.splitlines() == [
        "hint: nobody subscribes to '/robot/cmd_vel'; did you mean '/cmd_vel'?",
        'Timed out waiting for subscribers: Expected 1 subcribers but only got 0 subscribers',
    ]
    answer = ros2_here('topic', 'pub', *words)
    assert answer.status == 1
    assert answer.err.startswith('--max-wait-time-secs option is only effective with')


@pytest.mark.parametrize('ticks', [True, False])
def test_now_is_the_simulated_time(
    domain: int, ros2_here: Callable[..., Any], ticks: bool
) -> None:
    words = ('topic', 'pub', '-s', '--once', '-w', '0', '/x', 'std_msgs/msg/Header')
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'simulator')
        clock = node.create_publisher(Clock, '/clock', 10)
        now = Clock()
        now.clock.sec = 42
        if ticks:
            node.create_timer(0.1, lambda: clock.publish(now))
        answer = ros2_here(*words, '{stamp: now}')
    assert answer.status == 0
    assert f'Time(sec={42 if ticks else 0}, nanosec=0)' in answer.out
    told = 'hint: no time has come on /clock, so that `now` and `auto` are 0\n'
    assert (told in answer.err) == (not ticks)


@pytest.mark.usefixtures('processes')
def test_times_and_rate_are_kept(ros2_here: Callable[..., Any]) -> None:
    start = time.monotonic()
    answer = ros2_here('topic', 'pub', '-t', '5', '-w', '0', '-r', '10', '/x', 'std_msgs/Empty')
    assert answer.out.count('publishing #') == 5
    assert time.monotonic() - start > 0.4


@pytest.mark.usefixtures('processes')
def test_a_header_gets_the_time_when_it_asks_for_it(ros2_here: Callable[..., Any]) -> None:
    words = ('/x', 'std_msgs/msg/Header', '{stamp: now, frame_id: map}')
    out = ros2_here('topic', 'pub', '-t', '1', '-w', '0', *words).out
    (sec,) = [part for part in out.split('sec=') if part[0].isdigit()][:1]
    assert abs(int(sec.partition(',')[0]) - time.time()) < 60


@pytest.mark.usefixtures('domain')
def test_pub_names_what_it_refuses(ros2: Callable[..., Any]) -> None:
    bad = {
        ('std_msgs/msg/String', 'data: [1'): (1, 'is no YAML'),
        ('std_msgs/msg/String', '5'): (1, 'needs to be a dictionary in YAML format'),
        ('std_msgs/msg/String', ''): (1, """"{field: value}"; '' is empty"""),
        ('std_msgs/msg/String', 'text: x'): (1, "no attribute 'text'; its fields are data"),
        ('std_msgs/msg/Float32', 'data: 1e39'): (1, '1e+39 does not fit a float32'),
        ('std_msgs/msg/Float32', 'data: 3.4028235e38'): (1, '3.4028235e+38 is refused: a node'),
        ('std_msgs/msg/Int8', 'data: 300'): (1, '300 does not fit int8 (-128 to 127)'),
        ('std_msgs/msg/Bool', 'data: maybe'): (1, 'expected true or false'),
        ('geometry_msgs/msg/Twist', 'linear: 3'): (1, 'expected to be a dictionary'),
        ('std_msgs/msg/String', '-r', '0'): (2, 'must be a number above 0'),
    }
    calls = [('ros2cli.cli', 'topic', 'pub', '/x', *words) for words in bad]
    preload = ('ros2topic.verb.pub', 'rclpy')
    results = run_forked(*calls, preload=preload)
    for (words, (status, message)), ended in zip(bad.items(), results, strict=True):
        assert ended.status == status, (words, ended)
        assert message in ended.err, words
    answer = ros2(*calls[0][1:])
    assert (answer.status, answer.err) == (1, results[0].err)


def test_a_closed_pipe_ends_echo_without_a_word(processes: Any) -> None:
    processes.node('talker', 'talker')
    echo = processes.ros2('topic', 'echo', '/chatter', ready='data')
    echo.stdout.close()
    assert echo.wait(timeout=5) == 128 + signal.SIGPIPE


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_pub_and_leaves_no_shared_memory(processes: Any, number: int) -> None:
    publisher = processes.ros2('topic', 'pub', '/x', 'std_msgs/msg/Empty', ready='publishing')
    assert (shared := without_common_ports(own_files([publisher.pid])))
    publisher.send_signal(number)
    out, _ = publisher.communicate(timeout=5)
    assert 'Traceback' not in out
    assert left(shared) == []


def test_sigterm_ends_echo_while_it_prints(processes: Any, ros2: Callable[..., Any]) -> None:
    processes.node('talker', 'talker')
    # rclpy has shut ROS down before the callback is over, so that the next wait is refused.
    ends = "(os := __import__('os')).kill(os.getpid(), 15) or __import__('time').sleep(0.5)"
    answer = ros2('topic', 'echo', '/chatter', '--filter', ends)
    assert (answer.err, answer.status) == ('', signal.SIGINT)


@pytest.mark.usefixtures('domain')
def test_a_signal_before_the_node_is_made_ends_the_command(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    init = rclpy.init

    def interrupted_init(**options: Any) -> None:
        init(**options)
        rclpy.shutdown()  # what rclpy does for SIGINT and SIGTERM

    monkeypatch.setattr(rclpy, 'init', interrupted_init)
    with pytest.raises(KeyboardInterrupt), command_node():
        pass
