# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What every system test has: a DDS domain, a log folder and processes of its own."""

from collections.abc import Iterator
import os
from pathlib import Path
import subprocess

from husky_runtime.domains import OwnDomain
from playpen_testing import chromium
from playpen_testing.browser import start_browser
from playpen_testing.desk import Terminals
from playpen_testing.processes import Processes
from playpen_testing.spinning import SpunNodes
from playpen_testing.which_ros import lacks, SOURCED
from playwright.sync_api import Browser
import pytest

ROOT = Path(__file__).resolve().parent.parent
# That Ctrl-C ends a Python that still starts without a traceback is the work of underlay/.
collect_ignore = ['test_interrupts.py'] if SOURCED else []
if lacks('turtlesim') or lacks('tf2_ros'):
    collect_ignore.append('test_tutorials.py')
if lacks('cv_bridge'):
    collect_ignore.append('test_camera_node.py')
if os.geteuid() != 0:  # only root can make a folder that its own processes cannot write
    collect_ignore.append('test_shared_clone.py')


@pytest.fixture(scope='module')
def browser() -> Iterator[Browser]:
    """Start a browser; until it ends, Playwright's event loop bars any other from this thread."""
    with start_browser(chromium.find_or_install()) as started:
        yield started


@pytest.fixture(scope='session')
def short_course(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a course with a bend, for what is the same at the end of any drive."""
    course = tmp_path_factory.mktemp('course') / 'short.yaml'
    course.write_text('speed: 0.8\nwaypoints: [[0, 0], [-1, 0.5], [-2, 0]]\n')
    return course


@pytest.fixture(scope='session')
def built_packages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build every package as a copy; what `./lab` itself has built are links."""
    folder = tmp_path_factory.mktemp('built')
    bases = ['--build-base', str(folder / 'build'), '--install-base', str(folder / 'install')]
    colcon = ['colcon', '--log-base', str(folder / 'log'), 'build', '--base-paths', 'src']
    done = subprocess.run([*colcon, *bases], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / 'install'


@pytest.fixture
def domain_id(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[int]:
    """Give the test a DDS domain of its own, also in the environment of its children."""
    with OwnDomain() as domain:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain.number))
        monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path / 'ros_log'))
        monkeypatch.setenv('PYTHONUNBUFFERED', '1')
        monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(ROOT / 'config' / 'fastdds.xml'))
        yield domain.number


@pytest.fixture
def processes(domain_id: int) -> Iterator[Processes]:
    """Start real processes that all end with the test."""
    del domain_id  # the children must be in the test's domain
    with Processes() as started:
        yield started


@pytest.fixture
def nodes(domain_id: int) -> Iterator[SpunNodes]:
    """Spin real nodes in this process, in the test's domain."""
    with SpunNodes(domain_id) as spun:
        yield spun


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a student an empty home folder, to work in."""
    folder = tmp_path / 'home'
    folder.mkdir()
    monkeypatch.setenv('HOME', str(folder))
    monkeypatch.delenv('XDG_CACHE_HOME', raising=False)
    monkeypatch.chdir(folder)
    return folder


@pytest.fixture
def terminals(home: Path, processes: Processes) -> Iterator[Terminals]:
    """Give a student terminals, which begin in the home folder."""
    del home
    desk = Terminals(processes)
    yield desk
    desk.close()
