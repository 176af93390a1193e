# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the underlay share: an environment of their own, launch files, packages."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
import itertools
import os
from pathlib import Path
import select
import subprocess
import sys
import textwrap
import time
import warnings

from husky_runtime.domains import OwnDomain
from playpen_testing.processes import Child
import pytest

# Where a ROS 2 Jazzy is sourced nothing of underlay is installed, and there is nothing to test.
collect_ignore_glob = ['*'] if os.environ.get('HUSKY_LAB_ROS') == 'sourced' else []
_RUNNER = """
import sys
from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription
arguments = [word.split(':=', 1) for word in sys.argv[2:]]
service = LaunchService(argv=sys.argv[2:])
service.include_launch_description(
    LaunchDescription([IncludeLaunchDescription(sys.argv[1], launch_arguments=arguments)])
)
sys.exit(service.run())
"""


@dataclass(frozen=True)
class Launched:
    """What a launch has printed, and its exit status."""

    returncode: int
    output: str

    @property
    def lines(self) -> list[str]:
        return self.output.splitlines()


def start_launch(path: Path, *arguments: str) -> 'subprocess.Popen[str]':
    """Start a launch file as ``ros2 launch`` does, in a process of its own."""
    return Child(
        [sys.executable, '-c', _RUNNER, str(path), *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )


def finish_launch(process: 'subprocess.Popen[str]', timeout_sec: float = 20.0) -> Launched:
    """Wait for a launch to end, and kill it where it does not."""
    try:
        output, _ = process.communicate(timeout=timeout_sec)
    except subprocess.TimeoutExpired:
        process.kill()
        output, _ = process.communicate()
        pytest.fail(f'the launch did not end within {timeout_sec} s; it printed:\n{output}')
    return Launched(process.returncode, output)


@pytest.fixture
def launch_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Keep logs, environment variables and log handlers out of the other tests."""
    import launch.logging

    environment = dict(os.environ)
    monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path / 'ros_log'))
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.delenv('OVERRIDE_LAUNCH_PROCESS_OUTPUT', raising=False)
    launch.logging.reset()
    with OwnDomain() as domain:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain.number))
        yield
    launch.logging.reset()
    for name in set(os.environ) - set(environment):
        del os.environ[name]
    os.environ.update(environment)


@pytest.fixture
def launch_file(tmp_path: Path, launch_environment: None) -> Callable[..., Path]:
    """Return a function that writes a launch file and returns its path."""
    del launch_environment

    def write(text: str, name: str = 'test.launch.py') -> Path:
        path = tmp_path / name
        path.write_text(textwrap.dedent(text))
        return path

    return write


@pytest.fixture
def python_launch_file(launch_file: Callable[..., Path]) -> Callable[..., Path]:
    """Return a function that writes a Python launch file from the list of its actions."""

    def write(actions: str, name: str = 'test.launch.py', before: str = '') -> Path:
        return launch_file(
            'from launch import LaunchDescription\n'
            'from launch.actions import *\n'
            'from launch.conditions import *\n'
            'from launch.event_handlers import *\n'
            'from launch.events.process import *\n'
            'from launch.substitutions import *\n'
            f'{textwrap.dedent(before)}\n'
            'def generate_launch_description():\n'
            '    return LaunchDescription([\n'
            f'{textwrap.indent(textwrap.dedent(actions), "        ")}\n'
            '    ])\n',
            name,
        )

    return write


@pytest.fixture
def run_launch(launch_environment: None) -> Callable[..., Launched]:
    """Return a function that runs a launch file to its end."""
    del launch_environment

    def run(path: Path, *arguments: str, timeout_sec: float = 20.0) -> Launched:
        return finish_launch(start_launch(path, *arguments), timeout_sec)

    return run


@pytest.fixture
def launch_here(
    launch_environment: None,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> Callable[..., Launched]:
    """Return a function that runs a launch file to its end in this process."""
    del launch_environment
    from launch import LaunchDescription, LaunchService
    from launch.actions import IncludeLaunchDescription

    def run(path: Path, *arguments: str) -> Launched:
        capfd.readouterr()
        monkeypatch.setattr('launch.descriptions.executable._process_numbers', itertools.count(1))
        service = LaunchService(argv=list(arguments))
        pairs = [word.partition(':=')[::2] for word in arguments]
        included = IncludeLaunchDescription(str(path), launch_arguments=pairs)
        service.include_launch_description(LaunchDescription([included]))
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # pytest makes errors of them
            status = service.run()
        return Launched(status, ''.join(capfd.readouterr()))

    return run


@pytest.fixture
def interrupt_launch(launch_environment: None) -> Callable[..., Launched]:
    """Return a function that runs a launch file, and signals it after a line has come."""
    del launch_environment

    def run(path: Path, after: str, number: int, timeout_sec: float = 20.0) -> Launched:
        process = start_launch(path)
        assert process.stdout is not None
        seen = ''
        for line in process.stdout:
            seen += line
            if after in line:
                break
        else:
            pytest.fail(f'{after!r} never came; the launch printed:\n{seen}')
        process.send_signal(number)
        rest = finish_launch(process, timeout_sec)
        return Launched(rest.returncode, seen + rest.output)

    return run


@pytest.fixture
def terminal_launch(launch_environment: None) -> Iterator[Callable[[Path, str, bytes], str]]:
    """Return a function that runs a launch file at a terminal, and types after a line has come."""
    del launch_environment
    master, slave = os.openpty()

    def run(path: Path, after: str, keys: bytes) -> str:
        process = subprocess.Popen(
            ['setsid', '--ctty', sys.executable, '-c', _RUNNER, str(path)],
            stdin=slave,
            stdout=slave,
            stderr=slave,
        )
        output = ''
        deadline = time.monotonic() + 20.0
        try:
            while process.poll() is None and time.monotonic() < deadline:
                if select.select([master], [], [], 0.1)[0]:
                    output += os.read(master, 4096).decode(errors='replace')
                if keys and after in output:
                    os.write(master, keys)
                    keys = b''
        finally:
            process.kill()
            process.wait()
        while select.select([master], [], [], 0.1)[0]:
            output += os.read(master, 4096).decode(errors='replace')
        return output

    yield run
    os.close(master)
    os.close(slave)


@pytest.fixture
def launch_in_closed_terminal(launch_environment: None) -> Callable[[Path, str], str]:
    """Return a function that runs a launch file at a terminal, and closes it after a text."""
    del launch_environment

    def run(path: Path, until: str) -> str:
        master, slave = os.openpty()
        process = subprocess.Popen(
            ['setsid', '--ctty', sys.executable, '-c', _RUNNER, str(path)],
            stdin=slave,
            stdout=slave,
            stderr=slave,
        )
        os.close(slave)
        try:
            output = ''
            while until not in output:
                output += os.read(master, 4096).decode(errors='replace')
            os.close(master)
            process.wait(10.0)
        finally:
            process.kill()
            process.wait()
        return output

    return run


_NODE = """\
#!{python}
import json, sys, rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node('plain', automatically_declare_parameters_from_overrides=True)
publisher = node.create_publisher(String, 'chatter', 10)
parameters = {{name: value.value for name, value in node._parameters.items()}}
print('NODE ' + json.dumps([node.get_fully_qualified_name(), publisher.topic_name, parameters]))
print('ARGUMENTS ' + json.dumps(rclpy.utilities.remove_ros_args(sys.argv)[1:]))
node.get_logger().info('a log line')
node.destroy_node()
rclpy.shutdown()
"""


@pytest.fixture
def ros_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, launch_environment: None) -> Path:
    """Install a package 'some_pkg' with a node 'plain_node'; return its prefix."""
    del launch_environment
    prefix = tmp_path / 'prefix'
    index = prefix / 'share' / 'ament_index' / 'resource_index' / 'packages'
    programs = prefix / 'lib' / 'some_pkg'
    for folder in (index, programs, prefix / 'share' / 'some_pkg'):
        folder.mkdir(parents=True)
    (index / 'some_pkg').touch()
    program = programs / 'plain_node'
    program.write_text(_NODE.format(python=sys.executable))
    program.chmod(0o755)
    prefixes = [str(prefix), *filter(None, [os.environ.get('AMENT_PREFIX_PATH')])]
    monkeypatch.setenv('AMENT_PREFIX_PATH', os.pathsep.join(prefixes))
    return prefix
