# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The verbs that show the graph, with real nodes."""

from __future__ import annotations

from collections.abc import Callable
import contextlib
import os
from pathlib import Path
import signal
import socket
import struct
import sys
import time
from typing import Any

from playpen_testing.bags import opened_writer
from playpen_testing.processes import Processes
from playpen_testing.waiting import wait_until
import pytest
from ros2_diagnosis import nodes
from rtps_graph import announcements, graph, host, wire
from rtps_graph.observer import Observer
from rtps_graph.participant import Participant

NUMBER = 12
FEW = {'plain': 'node_00', 'talker': 'talker', 'listener': 'listener', 'service': 'server'}


@pytest.fixture(scope='module')
def few(shared_processes: Any) -> None:
    for kind, name in FEW.items():
        shared_processes.node(kind, name)


def _wait_for(names: set[str]) -> None:
    from ros2cli import discovery

    end = time.monotonic() + 20
    while missing := names - {node.full_name for node in discovery.read_graph(quiet=True).nodes}:
        assert time.monotonic() < end, f'{missing} did not start'


@pytest.mark.usefixtures('few')
def test_every_node_is_listed_in_every_run(ros2: Callable[..., Any]) -> None:
    from ros2cli import discovery

    others = [f'node_{i:02}' for i in range(1, NUMBER - len(FEW) + 1)]
    expected = sorted(f'/{name}' for name in (*FEW.values(), *others))
    assert len(expected) == NUMBER
    with Processes() as crowd:
        path = str(Path(__file__).with_name('nodes.py'))
        for name in others:
            crowd.start(sys.executable, path, 'plain', name)
        _wait_for({*expected})
        for _ in range(5):
            answer = ros2('node', 'list')
            assert (answer.status, answer.lines, answer.err) == (0, expected, '')
        # Without the command, the observer is complete twenty times of twenty.
        domain_id = discovery.settings_from_environment().domain_id
        start = time.monotonic()
        for _ in range(20):
            with Observer(domain_id=domain_id) as observer:
                assert observer.observe(timeout_sec=20.0), 'it waits for something in vain'
                found = graph.build(observer.participants.values())
            assert {node.full_name for node in found.nodes} == {*expected}
            assert {'/chatter', '/rosout', '/parameter_events'} <= found.topics().keys()
        assert (time.monotonic() - start) / 20 < 0.8


@pytest.mark.usefixtures('few')
def test_topics_are_listed_with_their_types(ros2: Callable[..., Any]) -> None:
    answer = ros2('topic', 'list', '--show-types')
    assert '/chatter [std_msgs/msg/String]' in answer.lines
    assert '/rosout [rcl_interfaces/msg/Log]' in answer.lines
    assert answer.lines == sorted(answer.lines)
    assert ros2('topic', 'list', '--count-topics').out == f'{len(answer.lines)}\n'


@pytest.mark.usefixtures('few')
def test_hidden_topics_are_shown_only_when_asked(ros2_here: Callable[..., Any]) -> None:
    hidden = '/flip/_service_event'
    assert hidden not in ros2_here('topic', 'list').lines
    assert hidden in ros2_here('topic', 'list', '--include-hidden-topics').lines
    assert hidden in ros2_here('topic', '--include-hidden-topics', 'list').lines
    answer = ros2_here('topic', 'type', hidden)
    assert (answer.status, answer.out, answer.err) == (1, '', '')
    assert ros2_here('topic', '--include-hidden-topics', 'type', hidden).status == 0


@pytest.mark.usefixtures('few')
def test_the_verbose_list_counts_publishers(ros2_here: Callable[..., Any]) -> None:
    published, _, subscribed = ros2_here('topic', 'list', '-v').out.partition('Subscribed topics:')
    assert ' * /chatter [std_msgs/msg/String] 1 publisher\n' in published
    assert f' * /rosout [rcl_interfaces/msg/Log] {len(FEW)} publishers\n' in published
    assert ' * /chatter [std_msgs/msg/String] 1 subscriber\n' in subscribed


@pytest.mark.usefixtures('few')
def test_topic_info_tells_type_and_counts(ros2: Callable[..., Any]) -> None:
    answer = ros2('topic', 'info', '/chatter')
    assert answer.lines == [
        'Type: std_msgs/msg/String',
        'Publisher count: 1',
        'Subscription count: 1',
    ]


@pytest.mark.usefixtures('few')
def test_verbose_topic_info_agrees_with_rclpy(ros2_here: Callable[..., Any]) -> None:
    import rclpy

    out = ros2_here('topic', 'info', '-v', '/chatter').out
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node('_probe', context=context)
    try:
        end = time.monotonic() + 10
        while not (infos := node.get_publishers_info_by_topic('/chatter')):
            assert time.monotonic() < end, 'rclpy did not find the publisher'
            time.sleep(0.02)
        (info,) = infos
        end = time.monotonic() + 10
        while info.node_name != 'talker':
            assert time.monotonic() < end, 'rclpy did not find the node of the publisher'
            time.sleep(0.02)
            (info,) = node.get_publishers_info_by_topic('/chatter')
    finally:
        node.destroy_node()
        rclpy.shutdown(context=context)
    ours = out.partition('Publisher count: 1\n\n')[2].partition('\n\nSubscription count')[0]
    assert ours == str(info)


@pytest.mark.usefixtures('few')
def test_node_info_has_upstreams_form(ros2: Callable[..., Any]) -> None:
    lines = ros2('node', 'info', '/talker').lines
    assert lines[:7] == [
        '/talker',
        '  Subscribers:',
        '',
        '  Publishers:',
        '    /chatter: std_msgs/msg/String',
        '    /parameter_events: rcl_interfaces/msg/ParameterEvent',
        '    /rosout: rcl_interfaces/msg/Log',
    ]
    assert '    /talker/get_parameters: rcl_interfaces/srv/GetParameters' in lines
    assert lines[-6:] == [
        '  Service Clients:',
        '',
        '  Action Servers:',
        '',
        '  Action Clients:',
        '',
    ]


@pytest.mark.usefixtures('few')
def test_an_unknown_node_is_refused_with_the_nearest_name(ros2_here: Callable[..., Any]) -> None:
    answer = ros2_here('node', 'info', '/taker')
    assert answer.status == 1
    assert answer.err == "Unable to find node '/taker'; did you mean '/talker'?\n"


@pytest.mark.usefixtures('few')
def test_types_and_names_find_each_other(ros2: Callable[..., Any]) -> None:
    assert ros2('topic', 'type', '/chatter').out == 'std_msgs/msg/String\n'
    assert ros2('topic', 'type', '/nothing').status == 1
    answer = ros2('service', 'type', '/flp')
    assert (answer.status, answer.out) == (1, '')
    assert answer.err == "hint: there is no service '/flp'; did you mean '/flip'?\n"
    answer = ros2('topic', 'find', 'std_msgs/msg/String')
    assert (answer.out, answer.err) == ('/chatter\n', '')
    answer = ros2('topic', 'find', 'std_msgs/String')  # as in ROS 1
    assert (answer.status, answer.out) == (0, '')
    assert answer.err == (
        "hint: no topic has the type 'std_msgs/String'; did you mean 'std_msgs/msg/String'?\n"
    )
    assert ros2('service', 'type', '/flip').out == 'std_srvs/srv/SetBool\n'
    assert ros2('service', 'find', 'std_srvs/srv/SetBool').lines == ['/flip']


@pytest.mark.usefixtures('few')
def test_services_are_listed(ros2: Callable[..., Any]) -> None:
    lines = ros2('service', 'list', '-t').lines
    assert '/flip [std_srvs/srv/SetBool]' in lines
    assert '/talker/list_parameters [rcl_interfaces/srv/ListParameters]' in lines
    assert ros2('service', 'info', '/flip').lines == [
        'Type: std_srvs/srv/SetBool',
        'Clients count: 0',
        'Services count: 1',
    ]


def test_a_stopped_process_is_named_and_the_others_are_shown(
    processes: Any, domain: int, ros2: Callable[..., Any]
) -> None:
    processes.node('plain', 'awake')
    asleep = processes.node('plain', 'asleep')
    asleep.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, asleep.pid, os.WSTOPPED)
    start = time.monotonic()
    with Observer(domain_id=domain) as observer:
        assert not observer.observe(timeout_sec=20.0), 'one of them cannot answer'
        assert len(observer.unanswered) == 1
    assert time.monotonic() - start < 10.0, 'it waits for one that is stopped'
    answer = ros2('node', 'list')
    assert answer.lines == ['/awake']
    assert 'hint: ' in answer.err
    assert 'does not answer' in answer.err
    assert '/udp' in answer.err


def test_a_process_that_is_stopped_amid_its_answer_is_not_waited_for(
    processes: Any, domain: int
) -> None:
    processes.node('plain', 'awake')
    asleep = processes.node('talker', 'asleep')
    ports = host.ports_of(Path(f'/proc/{asleep.pid}'))

    class Stopping(Observer):
        def _ask_participant(self, participant: Participant) -> None:
            if participant.discovery_port in ports:
                asleep.send_signal(signal.SIGSTOP)
                os.waitid(os.P_PID, asleep.pid, os.WSTOPPED | os.WNOWAIT)
            super()._ask_participant(participant)

    start = time.monotonic()
    with Stopping(domain_id=domain) as observer:
        assert not observer.observe(timeout_sec=20.0), 'one of them has not told all'
        assert len(observer.participants) == 2
        assert observer.unanswered < ports
    assert time.monotonic() - start < 10.0, 'it waits for one that is stopped'


def test_a_signal_ends_a_command_that_reads_the_graph(
    processes: Any, domain: int, tmp_path: Path
) -> None:
    opened_writer(tmp_path / 'bag', '/chatter').close()
    # Commands whose node handles the signals itself, or leaves them to rclpy.
    record = ('bag', 'record', '-a', '-o')
    rows = (
        ((signal.SIGINT,), (*record, str(tmp_path / 'interrupted'))),
        # Two at once, as where a launch and its terminal end together.
        ((signal.SIGINT, signal.SIGTERM), (*record, str(tmp_path / 'terminated'))),
        ((signal.SIGTERM,), ('bag', 'play', str(tmp_path / 'bag'))),
    )

    def participants() -> int:
        return len(host.participant_ports(domain, host.bound_udp_ports() or set()))

    with contextlib.ExitStack() as silent:
        # A participant that never answers, so that each of them reads for 8 s.
        last = host.discovery_ports(domain)[-1]
        for port in (last, last + 1):
            bound = silent.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            bound.bind(('127.0.0.1', port))
        started = [processes.ros2(*words) for _, words in rows]
        wait_until(
            lambda: participants() == 1 + len(rows), timeout_sec=20.0, what='a node of each'
        )
        start = time.monotonic()
        for (numbers, _), process in zip(rows, started, strict=True):
            for number in numbers:
                process.send_signal(number)
        for (_, words), process in zip(rows, started, strict=True):
            output, _ = process.communicate(timeout=20.0)
            assert time.monotonic() - start < 4.0, words
            assert 'Traceback' not in output
            assert ('Recording stopped: 0 messages' in output) == (words[1] == 'record')


def test_a_node_that_has_ended_is_gone_at_once(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('plain', 'stays')
    goes = processes.node('plain', 'goes')
    goes.kill()
    goes.wait()
    assert ros2_here('node', 'list').lines == ['/stays']


def test_a_node_that_is_killed_while_it_is_asked_holds_nobody_up(
    processes: Any, domain: int
) -> None:
    goes = processes.node('plain', 'goes')

    class Killing(Observer):
        def _ask_participant(self, participant: Participant) -> None:
            goes.kill()
            goes.wait()
            super()._ask_participant(participant)

    with Killing(domain_id=domain) as observer:
        assert observer.observe(timeout_sec=8.0), 'it waits for one that is dead'
        assert observer.participants == {}


def test_one_of_another_host_may_have_the_port_of_one_here(processes: Any, domain: int) -> None:
    """As mostly: the first participant of each host has the same."""
    processes.node('plain', 'here')

    class Meeting(Observer):
        def _ask_participant(self, participant: Participant) -> None:
            if participant.address == '127.0.0.1':
                other = announcements.participant(
                    b'other  host ', ['127.0.0.2'], participant.discovery_port
                )
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                    sender.bind(('127.0.0.2', 0))
                    sender.sendto(other, self._socket.getsockname())
            super()._ask_participant(participant)

    with Meeting(domain_id=domain) as observer:

        def is_complete() -> bool:
            assert not observer.observe(timeout_sec=1.0), 'the other one never answers'
            return any(each.complete for each in observer.participants.values())

        wait_until(is_complete, timeout_sec=20.0, what='all of one of them')
        known = {each.address: each for each in observer.participants.values()}
        found = graph.build(known.values(), observer.unanswered, observer.silent_hosts)
    (finding,) = nodes.check_silent(found, domain)
    assert 'host 127.0.0.2 announces itself and does not tell its nodes; what is ' in str(finding)
    assert known.keys() == {'127.0.0.1', '127.0.0.2'}
    assert known['127.0.0.1'].complete
    assert len({each.discovery_port for each in known.values()}) == 1


@pytest.mark.parametrize('port', [0, 70_000])
def test_one_that_sends_anything_hides_nobody(processes: Any, domain: int, port: int) -> None:
    processes.node('talker', 'here')
    prefix = b'enemy       '

    class Meeting(Observer):
        def _ask_participant(self, participant: Participant) -> None:
            address = self._socket.getsockname()
            reader, writer = wire.PUBLICATIONS_READER, wire.PUBLICATIONS_WRITER
            everything = wire._sequence(5) + wire._sequence(2**40) + struct.pack('<I', 0)
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                for message in (
                    announcements.participant(prefix, ['127.0.0.1'], port),
                    announcements.participant(prefix, ['127.0.0.1'], 7410),
                    wire.header(prefix) + wire.heartbeat(reader, writer, 1, 2**40, 1),
                    wire.header(prefix)
                    + wire._submessage(wire.GAP, 0, reader + writer + everything),
                    wire.header(prefix)
                    + wire.data(reader, writer, 1, wire.PL_CDR_LE + wire.parameter(5, b'')),
                ):
                    sender.sendto(message, address)
            super()._ask_participant(participant)

    with Meeting(domain_id=domain) as observer:

        def names() -> list[str]:
            observer.observe(timeout_sec=0.5)
            return [each.full_name for each in graph.build(observer.participants.values()).nodes]

        wait_until(lambda: names() == ['/here'], timeout_sec=20.0, what='the talker')
        assert prefix in observer.participants


@pytest.mark.usefixtures('domain')
def test_a_bad_domain_is_refused_in_one_line(
    monkeypatch: pytest.MonkeyPatch, ros2: Callable[..., Any]
) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', 'lab')
    answer = ros2('topic', 'list')
    assert answer.status == 2
    assert answer.err.startswith("ROS_DOMAIN_ID='lab' is refused: a domain is a number from 0")
    assert answer.err.count('\n') == 1
