# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of turtlesim share: a domain of their own, processes, a turtlesim, a client."""

from collections.abc import Iterator
from pathlib import Path

from husky_runtime.domains import OwnDomain
from playpen_testing.processes import Process, Processes
from playpen_testing.turtles import TurtleClient
import pytest

ROOT = Path(__file__).resolve().parent.parent.parent.parent


@pytest.fixture
def processes(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Processes]:
    """Start real processes that all end with the test, in a domain of its own."""
    with OwnDomain() as domain, Processes() as started:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain.number))
        monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path / 'ros_log'))
        monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(ROOT / 'config' / 'fastdds.xml'))
        monkeypatch.setenv('PYTHONUNBUFFERED', '1')
        for name in ('DISPLAY', 'WAYLAND_DISPLAY', 'QT_QPA_PLATFORM'):
            monkeypatch.delenv(name, raising=False)
        yield started


@pytest.fixture
def turtlesim(processes: Processes) -> Process:
    """Start a turtlesim without a page, and wait until it has its turtle."""
    started = processes.start(
        'ros2', 'run', 'turtlesim', 'turtlesim_node', '-platform', 'offscreen'
    )
    started.wait_for_text('Spawning turtle [turtle1] at')
    return started


@pytest.fixture
def student(turtlesim: Process) -> Iterator[TurtleClient]:
    """Make a node in the domain of the turtlesim."""
    with TurtleClient() as client:
        yield client
