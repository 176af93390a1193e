# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade whole workspaces: the lab's own packages as a student would hand them in, and broken."""

from collections.abc import Callable
import contextlib
import json
import os
from pathlib import Path
import shutil
import subprocess
import sys
import time

from husky_grader.grade import main as grade
from husky_grader.lab.file_steps import (
    build_step,
    driver_package,
    package_step,
    sourced,
    workspace_step,
)
from husky_grader.lab.graph_steps import publisher_step
from husky_grader.run.live import drive_live
import psutil
import pytest

# Neither its session, nor its parent, nor its environment tells where it comes from.
DAEMON = """
import os
if os.fork() == 0:
    os.setsid()
    os.closerange(0, 99)  # or colcon would wait for the end of its output
    os.open(os.devnull, os.O_RDWR), os.dup(0), os.dup(0)
    if os.fork() == 0:
        text = ('import os, sys, time; '
                'print(os.getpid(), file=open(sys.argv[1], "a"), flush=True); time.sleep(600)')
        os.execve({python!r}, [{python!r}, '-c', text, {pids!r}], {{}})
    os._exit(0)
os.wait()
"""
DEAF_COLCON = """#!%s
import os, signal, time
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, signal.SIG_IGN)
print('pid', os.getpid(), flush=True)
time.sleep(600)
"""
BUILD = """
from pathlib import Path
import sys
from husky_grader.lab.file_steps import build_step
build_step(Path(sys.argv[1]), Path(sys.argv[2]))
"""
PUBLISHER = """#!%s
import time, rclpy
from std_msgs.msg import String
rclpy.init()
publisher = rclpy.create_node('publisher').create_publisher(String, 'topic_test', 10)
for number in range(1000):
    publisher.publish(String(data=f'hello world {time.time()}'))
    time.sleep(%g if number != 15 else 1.0)
"""
SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """Return a workspace with our topic_demo and the template that students copy."""
    folder = tmp_path / 'CSE461_07_03'
    ignore = shutil.ignore_patterns('test', '__pycache__', '*.egg-info')
    shutil.copytree(SOURCE / 'topic_demo', folder / 'src' / 'topic_demo', ignore=ignore)
    template = SOURCE / 'husky_driver' / 'template' / 'my_driver'
    shutil.copytree(template, folder / 'src' / 'my_driver', ignore=ignore)
    return folder


@pytest.mark.parametrize(('period_sec', 'percent'), [(0.1, 100.0), (0.2, 70.0)])
def test_a_pause_of_a_publisher_does_not_change_its_rate(
    tmp_path: Path, period_sec: float, percent: float
) -> None:
    program = tmp_path / 'install' / 'topic_demo' / 'lib' / 'topic_demo' / 'publisher'
    program.parent.mkdir(parents=True)
    program.write_text(PUBLISHER % (sys.executable, period_sec))
    program.chmod(0o755)
    verdict = publisher_step(tmp_path, dict(os.environ))
    assert verdict[0] == percent, verdict


@pytest.mark.timeout(180)
def test_a_good_workspace_loses_points_only_for_its_drive(
    workspace: Path, tmp_path: Path, courses: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    profile = courses.parent / 'fastdds.xml'
    monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(profile))
    report = tmp_path / 'report'
    arguments = ['--lab', str(workspace), '--report', str(report), '--real-time-factor', '4']
    assert grade(arguments) == 1
    steps = {step['name']: step for step in json.loads((report / 'lab.json').read_text())['steps']}
    drive = steps.pop('drive')
    short = {name: step for name, step in steps.items() if step['points'] < step['most']}
    assert short == {}
    assert set(steps) == {
        *('workspace', 'package topic_demo', 'package my_driver'),
        *('build', 'publisher', 'subscriber'),
    }
    assert 0.0 < drive['points'] < drive['most']
    assert 'missed waypoint 3 at (2.7, -2.6)' in drive['why']
    assert (report / 'drive' / 'report.html').is_file()
    assert not (workspace / 'install').exists()


@pytest.mark.timeout(120)
def test_a_broken_workspace_is_told_what_to_do_at_every_step(
    workspace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    setup = workspace / 'src' / 'topic_demo' / 'setup.py'
    setup.write_text(setup.read_text().replace("'subscriber = ", "'listener = "))
    publisher = workspace / 'src' / 'topic_demo' / 'topic_demo' / 'publisher.py'
    publisher.write_text(publisher.read_text().replace("'topic_test'", "'topic_text'"))
    monkeypatch.setattr('husky_grader.lab.graph_steps.APPEAR_WITHIN_SEC', 6.0)
    shutil.rmtree(workspace / 'src' / 'my_driver')
    report = tmp_path / 'report'
    assert grade(['--lab', str(workspace), '--report', str(report)]) == 1
    why = {
        step['name']: step['why']
        for step in json.loads((report / 'lab.json').read_text())['steps']
        if step['points'] < step['most']
    }
    assert why['package husky_driver'].endswith('packages there: topic_demo')
    assert why['publisher'] == 'it publishes on /topic_text; the sheet asks for /topic_test'
    assert (
        'ros2 run topic_demo subscriber finds nothing; topic_demo has: listener'
        in (why['subscriber'])
    )
    assert 'ros2 run husky_driver follow_path finds nothing' in why['drive']


def test_a_workspace_of_another_name_gets_half_of_its_points(tmp_path: Path) -> None:
    (tmp_path / 'ws' / 'src').mkdir(parents=True)
    percent, why = workspace_step(tmp_path / 'ws')
    assert percent == 50.0
    assert 'CSE461_<section>_<group>' in why
    assert workspace_step(tmp_path)[0] == 0.0


def test_a_manifest_that_lacks_a_dependency_is_told_the_line(workspace: Path) -> None:
    manifest = workspace / 'src' / 'topic_demo' / 'package.xml'
    manifest.write_text(manifest.read_text().replace('<exec_depend>std_msgs</exec_depend>', ''))
    verdict = package_step(workspace, 'topic_demo')
    assert verdict == (50.0, 'package.xml lacks: <exec_depend>std_msgs</exec_depend>')
    assert driver_package(workspace) == 'my_driver'


def test_a_workspace_that_is_not_there_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert grade(['--lab', str(tmp_path / 'nothing')]) == 2
    assert 'no such folder; give your workspace' in capsys.readouterr().err


def running(pids: list[int]) -> list[int]:
    alive = []
    for pid in pids:
        with contextlib.suppress(psutil.NoSuchProcess):
            if psutil.Process(pid).status() != psutil.STATUS_ZOMBIE:
                alive.append(pid)
    return alive


def wait_for(fact: Callable[[], object], what: str) -> None:
    deadline = time.monotonic() + 10.0
    while not fact():
        assert time.monotonic() < deadline, f'not within 10 s: {what}'
        time.sleep(0.01)


def daemon(pids: Path) -> str:
    """Return a program that starts a daemon and waits until it has told its number."""
    ready = f'import os, time\nwhile not os.path.exists({str(pids)!r}): time.sleep(0.01)\n'
    return DAEMON.format(python=sys.executable, pids=str(pids)) + ready


def test_a_daemon_of_a_build_ends_with_the_build(workspace: Path, tmp_path: Path) -> None:
    shutil.rmtree(workspace / 'src' / 'my_driver')
    pids, report = tmp_path / 'pids', tmp_path / 'report'
    report.mkdir()
    setup = workspace / 'src' / 'topic_demo' / 'setup.py'
    setup.write_text(setup.read_text() + daemon(pids))
    percent, why = build_step(workspace, report)
    assert percent == 100.0, why
    assert 'Finished <<< topic_demo' in (report / 'build.log').read_text()
    assert running([int(pid) for pid in pids.read_text().split()]) == []


def test_a_build_ends_with_the_killed_grader(workspace: Path, tmp_path: Path) -> None:
    colcon, log = tmp_path / 'colcon', tmp_path / 'build.log'
    colcon.write_text(DEAF_COLCON % sys.executable)
    colcon.chmod(0o755)
    environment = {**os.environ, 'PATH': f'{tmp_path}{os.pathsep}{os.environ["PATH"]}'}
    command = [sys.executable, '-c', BUILD, str(workspace), str(tmp_path)]
    grader = subprocess.Popen(command, env=environment)
    wait_for(lambda: log.is_file() and log.read_text().endswith('\n'), 'the start of the build')
    pid = int(log.read_text().split()[1])
    assert running([pid])
    grader.kill()
    grader.wait()
    wait_for(lambda: not running([pid]), 'the end of the build')


@pytest.mark.parametrize(
    ('hook', 'why'), [('exit 3', 'exit code 3'), ('sleep 600', 'took longer than 1 s')]
)
def test_a_hook_that_breaks_the_shell_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, hook: str, why: str
) -> None:
    monkeypatch.setattr('husky_grader.lab.file_steps.SOURCE_WITHIN_SEC', 1.0)
    (tmp_path / 'install').mkdir()
    (tmp_path / 'install' / 'local_setup.bash').write_text(f'export KNOWN=1\n{hook}\n')
    with pytest.raises(ValueError, match=why):
        sourced(tmp_path)
    (tmp_path / 'install' / 'local_setup.bash').write_text('export KNOWN="a\nb"\n')
    assert sourced(tmp_path)['KNOWN'] == 'a\nb'


@pytest.mark.timeout(60)
def test_a_daemon_of_a_controller_ends_with_the_run(tmp_path: Path) -> None:
    pids, program = tmp_path / 'pids', tmp_path / 'controller.py'
    program.write_text(daemon(pids))
    course = tmp_path / 'course.yaml'
    course.write_text('waypoints: [[0, 0], [-2, 0]]')
    drive_live(f'{sys.executable} {program}', str(course), tmp_path / 'run')
    assert running([int(pid) for pid in pids.read_text().split()]) == []
