# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes that `ros2 doctor` tells apart by where they run: domain, network, user, machine."""

from __future__ import annotations

from collections.abc import Callable
import os
from pathlib import Path
import re
import shutil
import subprocess
import sys
from typing import Any

from husky_runtime.domains import OwnDomain
from playpen_testing.processes import find_line
from playpen_testing.waiting import wait_until
import pytest


def test_processes_that_cannot_meet(monkeypatch: pytest.MonkeyPatch) -> None:
    from ros2_diagnosis import places
    from rtps_graph.settings import Settings

    monkeypatch.setattr(places, '_LOOPBACK', '192.0.2.1')  # nobody has it: RFC 5737
    (finding,) = places.check_environment(Settings(0, 'LOCALHOST', ()))
    assert 'address 192.0.2.1: processes of this computer cannot meet there' in str(finding)


def test_a_discovery_server_is_noted(
    ros2: Callable[..., Any], domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('ROS_DISCOVERY_SERVER', '127.0.0.1:11899')
    assert 'ROS_DISCOVERY_SERVER=127.0.0.1:11899: nodes of' in ros2('doctor').of_check(
        'environment'
    )


def _told_of_domains(ros2_here: Callable[..., Any]) -> str:
    return ' '.join(line for line in ros2_here('doctor').lines if ' (domain): ' in line)


def _named_in(told: str) -> list[str]:
    return told.partition('in domain ')[2].partition(' on this')[0].split(', ')


def test_nodes_in_another_domain(
    processes: Any, ros2_here: Callable[..., Any], domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    processes.node('plain', 'elsewhere')
    with OwnDomain() as here:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(here.number))
        told: list[str] = []

        def is_told() -> bool:  # one that has no processor for 0.6 s is not heard
            told.append(_told_of_domains(ros2_here))
            return str(domain) in _named_in(told[-1])

        wait_until(is_told, timeout_sec=40.0, what=lambda: f'domain {domain}: {told}')
        assert 'export ROS_DOMAIN_ID=' in told[-1]
        hint = ros2_here('node', 'list')
    assert hint.out == ''
    assert hint.err.startswith('hint: domain ')


def test_a_daemon_in_another_domain_is_no_ros_process(
    ros2: Callable[..., Any],
    ros2_here: Callable[..., Any],
    domain: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert ros2('daemon', 'start').status == 0
    try:
        with OwnDomain() as here, monkeypatch.context() as elsewhere:
            elsewhere.setenv('ROS_DOMAIN_ID', str(here.number))
            # One that has no processor for 0.6 s would not be heard either way.
            told = [_told_of_domains(ros2_here) for _ in range(3)]
    finally:
        ros2('daemon', 'stop')
    assert str(domain) not in {name for each in told for name in _named_in(each)}


def test_a_node_that_lets_itself_not_be_found(
    processes: Any, ros2: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as elsewhere:
        elsewhere.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
        process = processes.node('plain', 'alone')
    hint = ros2('node', 'list').err
    assert f': process {process.pid} (' in hint
    assert ') was started with ROS_AUTOMATIC_DISCOVERY_RANGE=OFF, its nodes are not sh' in hint
    assert '; start it again with `export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST`\n' in hint


def test_nodes_on_another_machine() -> None:
    from ros2_diagnosis import places
    from rtps_graph.participant import Participant
    from rtps_graph.settings import Settings

    near = Participant(b'a' * 12, '127.0.0.1', 7410, 7411)
    far = Participant(b'b' * 12, '192.0.2.77', 7410, 7411)
    assert places.on_other_hosts([near, far], places.own_addresses()) == ['192.0.2.77']
    finding = places.range_finding(Settings(0, 'LOCALHOST', ()), ['192.0.2.77'])
    assert '1 ROS process of domain 0 on other machines (192.0.2.77) cannot be reached' in str(
        finding
    )
    assert 'export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET' in str(finding)


@pytest.mark.skipif(os.geteuid() != 0, reason='a second network needs root')
def test_a_peer_behind_a_network_interface_is_found(domain: int, ros2: Callable[..., Any]) -> None:
    ip = shutil.which('ip')
    if ip is None:
        pytest.skip('there is no `ip`')
    name = f'ros2test{os.getpid() % 1000}'
    commands = (
        f'netns add {name}',
        f'link add {name}a type veth peer name {name}b netns {name}',
        f'addr add 198.18.7.1/24 dev {name}a',
        f'link set {name}a up multicast on',
        f'route add 239.255.0.1/32 dev {name}a',
        f'-n {name} addr add 198.18.7.2/24 dev {name}b',
        f'-n {name} link set {name}b up multicast on',
        f'-n {name} link set lo up',
        f'-n {name} route add default dev {name}b',
    )
    environment = {**os.environ, 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'SUBNET'}
    node = None
    try:
        for command in commands:
            done = subprocess.run([ip, *command.split()], capture_output=True, text=True)
            if done.returncode:
                pytest.skip(f'ip {command}: {done.stderr.strip()}')
        path = str(Path(__file__).with_name('nodes.py'))
        node = subprocess.Popen(
            [ip, 'netns', 'exec', name, sys.executable, path, 'plain', 'far'],
            stdout=subprocess.PIPE, text=True, env=environment,
        )  # fmt: skip
        assert node.stdout is not None
        find_line(node.stdout, '^ready$')
        line = ros2('doctor').of_check('range')
        assert f'1 ROS process of domain {domain} on other machines (198.18.7.2)' in line
        assert 'export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET' in line
    finally:
        if node is not None:
            node.kill()
            node.communicate()
        subprocess.run([ip, 'link', 'del', f'{name}a'], capture_output=True)
        subprocess.run([ip, 'netns', 'del', name], capture_output=True)


@pytest.mark.skipif(os.geteuid() != 0, reason='a process of another user needs root')
def test_nodes_of_another_user_are_told_apart(
    processes: Any, ros2: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('OF_USER', '65534')
    processes.node('service', 'server', '--ros-args', '--disable-external-lib-logs')
    answer = ros2('doctor')
    line = answer.of_check('memory')
    assert "/server: of another user, 'nobody': it is seen, but no message passes; " in line
    assert '`export ROS_DOMAIN_ID=1` in your terminals keeps you apart' in line
    assert ' (answers): ' not in answer.out  # the node is not to blame
    call = ('service', 'call', '/flip', 'std_srvs/srv/SetBool')
    processes.ros2(*call, ready="hint: /server: of another user, 'nobody'")


def test_nodes_whose_shared_memory_is_gone_are_named(
    processes: Any, ros2: Callable[..., Any]
) -> None:
    talker = processes.node('talker', 'talker')
    for name in set(
        re.findall(r'/dev/shm/fastrtps_\w+', Path(f'/proc/{talker.pid}/maps').read_text())
    ):
        Path(name).unlink()
    where = "/talker: its shared memory is not in this terminal's /dev/shm"
    assert where in ros2('doctor').of_check('memory')
    processes.ros2('topic', 'echo', '/chatter', ready=f'hint: {where}')


def test_a_missing_profile_and_an_empty_prefix_are_named(
    domain: int, ros2: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('AMENT_PREFIX_PATH', '')
    line = ros2('doctor').of_check('environment')
    assert 'AMENT_PREFIX_PATH: is empty' in line
    assert domain
