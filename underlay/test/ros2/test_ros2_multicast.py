# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 multicast` over real UDP."""

from __future__ import annotations

from collections.abc import Callable
import socket
import time
from typing import Any

import pytest
from ros2multicast import api


@pytest.fixture
def port() -> str:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(('', 0))
        return str(free.getsockname()[1])


def test_a_datagram_is_received(processes: Any, ros2: Callable[..., Any], port: str) -> None:
    receiver = processes.ros2('multicast', 'receive', '--port', port, ready='Waiting for UDP')
    deadline = time.monotonic() + 20.0
    while receiver.poll() is None and time.monotonic() < deadline:
        sent = ros2('multicast', 'send', '--port', port, '--ttl', '1')  # it may not listen yet
        assert sent.out == 'Sending one UDP multicast datagram...\n'
    out, _ = receiver.communicate(timeout=5)
    assert out.startswith('Received from ')
    assert out.endswith(": 'Hello World!'\n")


def test_other_groups_are_not_heard(port: str) -> None:
    with api.open_receiver('225.0.0.2', int(port)) as receiver:
        receiver.settimeout(5.0)
        api.send(b'other', group='225.0.0.3', port=int(port))
        api.send(b'mine', group='225.0.0.2', port=int(port))
        assert receiver.recv(16) == b'mine'


def test_a_wrong_group_is_refused(ros2: Callable[..., Any]) -> None:
    answer = ros2('multicast', 'receive', '--group', '10.0.0.1')
    assert answer.status == 1
    assert "multicast group '10.0.0.1', port 49150 cannot be used: " in answer.err
