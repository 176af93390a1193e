# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""DDS domains: one to oneself, and one simulator in each."""

from collections.abc import Iterator
from pathlib import Path
import signal
import subprocess
import sys
import tempfile

from husky_runtime.domains import DomainError, Lock, lock_simulator, OwnDomain
import pytest
import rclpy
from rclpy.context import Context

from husky_runtime import domains

HOLD = """
import sys
from husky_runtime.domains import OwnDomain
with OwnDomain() as domain:
    print(domain.number, flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def holder() -> Iterator['subprocess.Popen[str]']:
    """Start a process that takes a domain and prints its number."""
    process = subprocess.Popen(
        [sys.executable, '-c', HOLD], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    yield process
    process.kill()
    process.communicate()


def number_of(holder: 'subprocess.Popen[str]') -> int:
    assert holder.stdout is not None
    return int(holder.stdout.readline())


def test_no_two_runs_get_the_same_domain() -> None:
    taken = [OwnDomain() for _ in range(20)]
    assert len({domain.number for domain in taken}) == len(taken)
    for domain in taken:
        domain.close()


def test_a_domain_is_taken_until_its_process_is_killed(
    holder: 'subprocess.Popen[str]', monkeypatch: pytest.MonkeyPatch
) -> None:
    number = number_of(holder)
    monkeypatch.setattr(domains, 'DOMAINS', (number,))
    with pytest.raises(DomainError, match='taken'):
        OwnDomain()
    holder.send_signal(signal.SIGKILL)
    holder.wait()
    with OwnDomain() as domain:
        assert domain.number == number


def test_a_domain_with_another_participant_is_not_taken(
    domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    node = rclpy.create_node('other', context=context)
    monkeypatch.setattr(domains, 'DOMAINS', (domain,))
    monkeypatch.setattr(domains, 'Lock', lambda name: Lock(f'{name}_of_test'))
    with pytest.raises(DomainError, match='left over'):
        OwnDomain()
    node.destroy_node()
    context.try_shutdown()


@pytest.mark.parametrize(
    ('wanted', 'found'), [('', 'LOCALHOST'), ('OFF', 'LOCALHOST'), ('SUBNET', 'SUBNET')]
)
def test_nodes_of_a_run_find_each_other(
    monkeypatch: pytest.MonkeyPatch, wanted: str, found: str
) -> None:
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', wanted)
    with OwnDomain() as domain:
        assert domain.environment['ROS_AUTOMATIC_DISCOVERY_RANGE'] == found


def test_a_computer_whose_processes_cannot_meet_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(domains, '_LOOPBACK', '192.0.2.1')  # an address that nobody has: RFC 5737
    with pytest.raises(DomainError, match='its loopback interface is not set up; on Linux `ip'):
        OwnDomain()


def test_other_domains_have_simulators_of_their_own() -> None:
    first, second = lock_simulator(1001), lock_simulator(1002)
    with pytest.raises(DomainError, match='another simulator runs in ROS domain 1001'):
        lock_simulator(1001)
    first.close()
    lock_simulator(1001).close()
    second.close()


def test_without_abstract_sockets_a_file_is_locked(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(sys, 'platform', 'darwin')
    monkeypatch.setattr(tempfile, 'tempdir', str(tmp_path))
    lock = Lock('name')
    with pytest.raises(BlockingIOError, match='name is held'):
        Lock('name')
    lock.close()
    Lock('name').close()
