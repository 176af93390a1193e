# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The RTPS messages that the graph is read with."""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path
import resource
import socket
import struct
import subprocess
import sys
import time
from typing import Any

from ament_index_python.packages import get_package_share_directory
from hypothesis import given, settings
from hypothesis import strategies as st
import pytest
from rtps_graph import announcements, graph, host, names, wire
from rtps_graph.observer import Observer
from rtps_graph.participant import Participant, Samples

PREFIX = bytes(range(12))
# Opens sockets one after the other, and closes the oldest.
CHURN = """
import socket
sockets = []
while True:
    sockets.append(socket.socket(type=socket.SOCK_DGRAM))
    sockets[-1].bind(('127.0.0.1', 0))
    if len(sockets) > 20:
        sockets.pop(0).close()
"""
READER, WRITER = wire.PUBLICATIONS_READER, wire.PUBLICATIONS_WRITER


def _parse(body: bytes) -> list[wire.Submessage]:
    return list(wire.parse(wire.header(PREFIX) + body, own_prefix=PREFIX))


def test_data_is_read_as_it_was_written() -> None:
    payload = wire.PL_CDR_LE + wire.parameter(5, wire.string('rt/chatter')) + wire.sentinel()
    (message,) = _parse(wire.data(READER, WRITER, 2**33 + 5, payload))
    assert message.first == 2**33 + 5
    assert (message.source, message.writer_id) == (PREFIX, WRITER)
    assert wire.parameters(message.payload)[5] == [wire.string('rt/chatter') + b'\0']


def test_a_heartbeat_tells_the_range() -> None:
    (message,) = _parse(wire.heartbeat(READER, WRITER, 3, 12, 1))
    assert (message.kind, message.first, message.last) == (wire.HEARTBEAT, 3, 12)


def test_a_farewell_is_seen_as_one() -> None:
    key = PREFIX + wire.PARTICIPANT
    (message,) = _parse(wire.dispose(wire.SPDP_READER, wire.SPDP_WRITER, 2, key))
    assert message.disposed


@pytest.mark.parametrize(('missing', 'bits'), [({4}, '80000000'), ({4, 6, 35}, 'a0000001')])
def test_an_acknowledgement_asks_by_bits_from_the_left(missing: set[int], bits: str) -> None:
    body = wire.acknack(READER, WRITER, base=4, missing=missing, count=1)
    # Behind kind, flags, length, ids, base and number of bits stands the bitmap, little endian.
    word = body[4 + 8 + 8 + 4 :][:4]
    assert word[::-1].hex() == bits


def test_what_is_meant_for_others_is_left_out() -> None:
    other = bytes(reversed(PREFIX))
    heartbeat = wire.heartbeat(READER, WRITER, 1, 1, 1)
    assert _parse(wire.info_destination(other) + heartbeat) == []
    assert len(_parse(wire.info_destination(PREFIX) + heartbeat)) == 1


@settings(max_examples=500)
@given(st.binary(max_size=80), st.sampled_from([6, 7, 8, 9, 12, 14, 21, 22]), st.integers(0, 255))
def test_no_bytes_from_the_network_break_the_parser(body: bytes, kind: int, flags: int) -> None:
    for datagram in (body, bytes((kind, flags)) + body):
        for message in _parse(datagram):
            assert len(message.source) <= 12
            with contextlib.suppress(ValueError):  # It says that this is no parameter list.
                wire.parameters(message.payload)


def test_a_status_that_is_cut_short_is_none() -> None:
    body = wire.dispose(READER, WRITER, 2, PREFIX + wire.PARTICIPANT)[4:]
    status = wire.parameter(wire.PID_STATUS_INFO, bytes((0, 0, 0, 3)))
    end = body.index(status) + len(status) - 4
    (message,) = _parse(wire._submessage(wire.DATA, 0x02, body[:end]))
    assert not message.disposed


@settings(max_examples=300)
@given(st.data())
def test_no_announcement_breaks_the_graph(data: st.DataObject) -> None:
    participant = Participant(PREFIX, '127.0.0.1', 7410, 7411)
    topic = {wire.PID_TOPIC_NAME: [wire.string('rt/a')], wire.PID_TYPE_NAME: [wire.string('b')]}
    pids = (wire.PID_TOPIC_NAME, wire.PID_TYPE_NAME, wire.PID_RELIABILITY, wire.PID_DEADLINE)
    others = data.draw(st.dictionaries(st.sampled_from(pids), st.lists(st.binary(max_size=9))))
    participant.writers = {PREFIX + WRITER: {**topic, **others}}
    participant.graph_sample = data.draw(st.none() | st.binary(max_size=99))
    built = graph.build([participant])
    told = [each.full_name for each in built.nodes]
    told += [text for each in built.endpoints for text in (each.name, each.type)]
    assert all(map(str.isprintable, told))


def test_a_node_list_has_no_more_than_was_sent() -> None:
    text = wire.string('n') + bytes(2)
    sample = wire.PL_CDR_LE + bytes(16) + struct.pack('<I', 1) + 2 * text
    participant = Participant(PREFIX, '127.0.0.1', 7410, 7411)
    participant.graph_sample = sample + struct.pack('<I', 2**32 - 1) + bytes(32)
    assert graph.build([participant]).nodes == []


def test_what_a_terminal_would_obey_is_not_shown() -> None:
    participant = Participant(PREFIX, '127.0.0.1', 7410, 7411)
    topic = {wire.PID_TOPIC_NAME: [wire.string('rt/\x1b[2J\u202ea')]}
    participant.writers = {PREFIX + WRITER: topic}
    (endpoint,) = graph.build([participant]).endpoints
    assert endpoint.name == '/\ufffd[2J\ufffda'


def test_samples_are_asked_for_until_all_have_come() -> None:
    samples = Samples()
    assert not samples.complete
    samples.announce(3, 8)
    assert samples.missing == {3, 4, 5, 6, 7, 8}
    samples.add(4, 8)
    samples.pass_over(6, 8)
    assert (samples.missing, samples.complete) == ({3, 5}, False)
    assert (samples.has(2), samples.has(4), samples.has(5)) == (True, True, False)
    samples.add(3)
    samples.add(5)
    assert (samples.missing, samples.complete) == (set(), True)
    samples.announce(3, 9)
    assert samples.missing == {9}


def test_a_range_takes_no_more_memory_than_a_question() -> None:
    samples = Samples()
    samples.announce(1, 2**40)
    samples.pass_over(5, 2**40)
    assert samples.missing == {1, 2, 3, 4}
    samples.add(1, 2, 3, 4)
    assert min(samples.missing) <= 260
    samples.pass_over(min(samples.missing), 2**40)
    assert samples.missing == {2**40}
    for number in (-1, 2**63 - 1):
        with pytest.raises(ValueError, match='is the number of no sample'):
            samples.announce(1, number)


def test_ports_and_participants_are_those_of_the_standard() -> None:
    assert host.multicast_port(5) == 7400 + 5 * 250
    assert list(host.discovery_ports(0)[:3]) == [7410, 7412, 7414]


@pytest.mark.parametrize(
    ('dds', 'ros'),
    [
        ('std_msgs::msg::dds_::String_', 'std_msgs/msg/String'),
        ('a::action::dds_::B_FeedbackMessage_', 'a/action/B_FeedbackMessage'),
        ('MyOwnType', 'MyOwnType'),
    ],
)
def test_types_are_told_in_the_spelling_of_ros(dds: str, ros: str) -> None:
    assert names.ros_type(dds) == ros


def test_topics_services_and_others_are_told_apart() -> None:
    assert names.ros_topic('rt/a/b') == ('rt', '/a/b')
    assert names.ros_topic('rq/flipRequest') == ('rq', '/flip')
    assert names.ros_topic('rr/flipReply') == ('rr', '/flip')
    assert names.ros_topic('square') == ('', 'square')
    assert names.service_type('s::srv::dds_::Flip_Request_') == 's/srv/Flip'


def test_an_action_is_known_by_its_feedback() -> None:
    qos = graph.Qos(True, False, None, None, False, None)
    feedback = graph.Endpoint(
        b'1', graph.Role.PUBLISHER, '/f/_action/feedback', 'a/action/F_FeedbackMessage', '', qos
    )
    node = graph.Node('server', '/', [feedback])
    assert node.action_servers() == {'/f': ['a/action/F']}
    assert graph.Graph([node], [feedback]).actions() == {'/f': ['a/action/F']}


def test_the_graph_topic_is_announced_with_the_hash_of_its_type() -> None:
    types = Path(get_package_share_directory('rmw_dds_common')) / 'msg'
    described = json.loads((types / 'ParticipantEntitiesInfo.json').read_text())
    (own, *_) = (e['hash_string'] for e in described['type_hashes'])
    assert f'typehash={own};'.encode() in announcements.graph_reader(PREFIX, PREFIX, 1)


def test_no_port_is_missed_while_others_open_and_close_sockets() -> None:
    with contextlib.ExitStack() as stack:
        ports = set()
        for _ in range(80):  # more than a page of the kernel's table
            kept = stack.enter_context(socket.socket(type=socket.SOCK_DGRAM))
            kept.bind(('127.0.0.1', 0))
            ports.add(kept.getsockname()[1])
        others = stack.enter_context(subprocess.Popen([sys.executable, '-c', CHURN]))
        stack.callback(others.kill)
        for number in range(100):
            bound = host.bound_udp_ports()
            assert bound is not None
            assert ports - bound == set(), f'look {number} misses some'


def test_on_a_busy_machine_what_has_come_is_read_before_more_is_asked_for(
    processes: Any, domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    processes.node('plain', 'quiet')
    look = host.bound_udp_ports

    def late() -> set[int] | None:
        time.sleep(0.1)  # as where others have the processor meanwhile
        return look()

    monkeypatch.setattr(host, 'bound_udp_ports', late)
    with Observer(domain_id=domain) as observer:
        assert observer.observe(timeout_sec=3.0), 'not all that the node announced was read'
        found = graph.build(observer.participants.values())
    assert [node.full_name for node in found.nodes] == ['/quiet']


def test_a_process_with_many_open_files_reads_the_graph(domain: int) -> None:
    with contextlib.ExitStack() as opened:
        before = resource.getrlimit(resource.RLIMIT_NOFILE)
        _, most = before
        resource.setrlimit(resource.RLIMIT_NOFILE, (min(most, 4096), most))
        opened.callback(resource.setrlimit, resource.RLIMIT_NOFILE, before)
        for _ in range(1100):
            opened.enter_context(Path(os.devnull).open())
        with Observer(domain_id=domain) as observer:
            assert observer.observe(timeout_sec=3.0)
