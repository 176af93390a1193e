# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of turtlesim share: a domain, processes, a turtlesim of a module, a client."""

from collections.abc import Iterator
from pathlib import Path

from husky_runtime.domains import OwnDomain
from playpen_testing.processes import Process, Processes
from playpen_testing.turtles import TurtleClient
import pytest
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from std_srvs.srv import Empty

ROOT = Path(__file__).resolve().parent.parent.parent.parent
PARAMETERS = {'background_r': 69, 'background_g': 86, 'background_b': 255, 'holonomic': False}


@pytest.fixture(scope='module')
def shared_domain(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Give all tests of a module one domain, that of their shared turtlesim."""
    with pytest.MonkeyPatch.context() as monkeypatch, OwnDomain() as domain:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain.number))
        monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path_factory.mktemp('ros_log')))
        monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(ROOT / 'config' / 'fastdds.xml'))
        monkeypatch.setenv('PYTHONUNBUFFERED', '1')
        for name in ('DISPLAY', 'WAYLAND_DISPLAY', 'QT_QPA_PLATFORM'):
            monkeypatch.delenv(name, raising=False)
        yield


@pytest.fixture
def own_domain(shared_domain: None, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Give a test that starts a turtlesim a domain without the shared one."""
    del shared_domain
    with OwnDomain() as domain:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain.number))
        yield


@pytest.fixture
def processes(shared_domain: None) -> Iterator[Processes]:
    """Start real processes that all end with the test."""
    del shared_domain
    with Processes() as started:
        yield started


@pytest.fixture(scope='module')
def shared_processes(shared_domain: None) -> Iterator[Processes]:
    del shared_domain
    with Processes() as started:
        yield started


@pytest.fixture(scope='module')
def shared_turtlesim(shared_processes: Processes) -> Process:
    """Start a turtlesim without a page, and wait until it has its turtle."""
    return started_turtlesim(shared_processes)


@pytest.fixture
def own_turtlesim(own_domain: None, processes: Processes) -> Process:
    """Start a turtlesim for a test that looks at its start, or ends it."""
    del own_domain
    return started_turtlesim(processes)


def started_turtlesim(processes: Processes) -> Process:
    started = processes.start(
        'ros2', 'run', 'turtlesim', 'turtlesim_node', '-platform', 'offscreen'
    )
    started.wait_for_text('Spawning turtle [turtle1] at')
    return started


@pytest.fixture
def turtlesim(shared_turtlesim: Process) -> Iterator[Process]:
    """Reset the shared turtlesim; what it has printed before is forgotten."""
    assert shared_turtlesim.returncode is None, shared_turtlesim.output
    shared_turtlesim.lines.clear()
    with TurtleClient() as client:
        client.call(Empty, 'reset')
    for text in ('Resetting turtlesim.', 'Spawning turtle [turtle1] at'):
        shared_turtlesim.wait_for_text(text)
    shared_turtlesim.lines.clear()
    yield shared_turtlesim
    print(f'turtlesim printed:\n{shared_turtlesim.output}')


@pytest.fixture
def student(turtlesim: Process) -> Iterator[TurtleClient]:
    """Make a node in the domain of the turtlesim."""
    del turtlesim
    with TurtleClient() as client:
        yield client


@pytest.fixture
def default_parameters(student: TurtleClient) -> Iterator[None]:
    """Set back in the end what a test sets and a reset leaves."""
    yield
    values = [Parameter(name, value=value) for name, value in PARAMETERS.items()]
    messages = [value.to_parameter_msg() for value in values]
    student.call(SetParameters, 'turtlesim/set_parameters', parameters=messages)
