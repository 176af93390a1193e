# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the `ros2` command share: a domain of their own, the command, processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, ExitStack
from dataclasses import dataclass
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import time

from husky_runtime.domains import OwnDomain
from playpen_testing.fast_dds import without_port_race
from playpen_testing.here import run_here
from playpen_testing.keyboard import Keyboard
from playpen_testing.processes import Child, find_line
import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent.parent


@dataclass(frozen=True)
class Answer:
    """What a command has printed, and its exit status."""

    status: int
    out: str
    err: str

    @property
    def lines(self) -> list[str]:
        return self.out.splitlines()

    def of_check(self, name: str) -> str:
        """Return the one line of a check of `ros2 doctor`."""
        found = [line for line in self.lines if f' ({name}): ' in line]
        assert len(found) == 1, self
        return found[0]


Ros2 = Callable[..., Answer]


class Processes:
    """Processes that end with the test."""

    def __init__(self) -> None:
        self._started: list[subprocess.Popen[str]] = []

    def start(self, *words: str, ready: str | None = None) -> subprocess.Popen[str]:
        """Start a process; where `ready` is given, wait until it has printed a line with it."""
        process = Child(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self._started.append(process)
        if ready is not None:
            assert process.stdout is not None
            find_line(process.stdout, re.escape(ready))
        return process

    def node(self, kind: str, name: str, *arguments: str) -> subprocess.Popen[str]:
        """Start one of the nodes in nodes.py and wait until it spins."""
        return self.start(
            sys.executable, str(HERE / 'nodes.py'), kind, name, *arguments, ready='ready'
        )

    def ros2(self, *words: str, ready: str | None = None) -> subprocess.Popen[str]:
        return self.start(sys.executable, '-m', 'ros2cli', *words, ready=ready)

    def background(self, *words: str, ready: str | None = None) -> subprocess.Popen[str]:
        """Start a process as a script starts its jobs in the background: with SIGINT ignored."""
        return self.start('sh', '-c', 'trap "" INT; exec "$@"', 'sh', *words, ready=ready)

    def end(self) -> None:
        for process in self._started:
            _interrupt(process)
        for process in self._started:
            _await_end(process)

    def end_one(self, process: subprocess.Popen[str]) -> None:
        """End a process before the others."""
        _interrupt(process)
        _await_end(process)
        self._started.remove(process)


def _interrupt(process: subprocess.Popen[str]) -> None:
    process.send_signal(signal.SIGCONT)
    process.send_signal(signal.SIGINT)


def _await_end(process: subprocess.Popen[str]) -> None:
    try:
        process.communicate(timeout=5)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()


@contextmanager
def own_domain(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """Move this process and its children to a domain that is not in use."""
    with OwnDomain() as domain:
        _set_environment(monkeypatch, domain.number)
        yield domain.number


def _set_environment(monkeypatch: pytest.MonkeyPatch, domain_id: int) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', str(domain_id))
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(ROOT / 'config' / 'fastdds.xml'))
    monkeypatch.setenv('PYTHONUNBUFFERED', '1')
    for name in ('ROS_STATIC_PEERS', 'ROS_LOCALHOST_ONLY'):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def domain(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[int]:
    monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path / 'ros_log'))
    monkeypatch.chdir(tmp_path)  # away from the workspace of the project
    with own_domain(monkeypatch) as number:
        yield number


@pytest.fixture(scope='module')
def shared_domain(tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    """Give all tests of a module one domain."""
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path_factory.mktemp('ros_log')))
        with own_domain(monkeypatch) as number:
            yield number


@pytest.fixture
def processes(domain: int) -> Iterator[Processes]:
    del domain  # the processes must be in the test's domain
    started = Processes()
    yield started
    started.end()


@pytest.fixture(scope='module')
def shared_processes(shared_domain: int) -> Iterator[Processes]:
    del shared_domain
    started = Processes()
    yield started
    started.end()


@pytest.fixture
def ros2() -> Ros2:
    """Return a function that runs the command to its end, or interrupts it after a time."""

    def run(
        *words: str,
        interrupt_after_sec: float | None = None,
        timeout_sec: float = 20.0,
        folder: Path | None = None,
        text: str | None = None,
    ) -> Answer:
        process = subprocess.Popen(
            [sys.executable, '-m', 'ros2cli', *words],
            stdin=subprocess.PIPE if text is not None else None,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=folder,
        )
        try:
            if interrupt_after_sec is not None:
                end = time.monotonic() + interrupt_after_sec
                while process.poll() is None and time.monotonic() < end:
                    time.sleep(0.02)
                process.send_signal(signal.SIGINT)
            out, err = process.communicate(text, timeout=timeout_sec)
        except subprocess.TimeoutExpired:
            process.kill()
            out, err = process.communicate()
            pytest.fail(f'ros2 {" ".join(words)} did not end; it printed:\n{out}{err}')
        assert 'Traceback' not in err, err
        return Answer(process.returncode, without_port_race(out), err)

    return run


@pytest.fixture
def ros2_here(capfd: pytest.CaptureFixture[str]) -> Ros2:
    """
    Return a function that runs the command to its end in this process, which has loaded ROS.

    Its node is a real one, in the domain of the test; what it costs to start is left out.
    """

    def run(*words: str) -> Answer:
        ended = run_here(capfd, 'ros2cli.cli', *words)
        assert 'Traceback' not in ended.err, ended.err
        return Answer(ended.status, ended.out, ended.err)

    return run


@pytest.fixture
def in_terminal() -> Iterator[Callable[..., Keyboard]]:
    """Return a function that runs a command in a terminal of its own."""
    with ExitStack() as ends:

        def run(*command: str) -> Keyboard:
            terminal = Keyboard(*command)
            ends.callback(terminal.close)
            return terminal

        yield run


def make_package(prefix: Path, name: str, **programs: str) -> Path:
    """Install a package with the given programs (shell or Python text by name)."""
    index = prefix / 'share' / 'ament_index' / 'resource_index' / 'packages'
    folder = prefix / 'lib' / name
    for needed in (index, folder, prefix / 'share' / name):
        needed.mkdir(parents=True, exist_ok=True)
    (index / name).touch()
    for program, text in programs.items():
        (folder / program).write_text(text)
        (folder / program).chmod(0o755)
    return prefix


@pytest.fixture
def sources(ros2: Ros2, domain: int, tmp_path: Path) -> Path:
    """Return the `src` of a workspace with the package `mine`, whose program `hello` says Hi."""
    del domain  # it has a folder of logs
    source = tmp_path / 'src'
    source.mkdir()
    ros2(
        'pkg', 'create', 'mine', '--build-type', 'ament_python', '--node-name', 'hello',
        '--license', 'MIT', folder=source,
    )  # fmt: skip
    return source


@pytest.fixture
def installed_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Path]:
    """Return a function that installs a package in a prefix of the test."""

    def install(name: str, **programs: str) -> Path:
        prefix = make_package(tmp_path / 'prefix', name, **programs)
        others = os.environ.get('AMENT_PREFIX_PATH', '')
        if str(prefix) not in others.split(os.pathsep):
            monkeypatch.setenv('AMENT_PREFIX_PATH', f'{prefix}{os.pathsep}{others}')
        return prefix

    return install
