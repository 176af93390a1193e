# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a run killed hard: the rest ends, nothing stays, and the next run is right."""

from collections.abc import Iterator
from contextlib import suppress
import json
from pathlib import Path
import signal
import sys
import time

from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_grader.run.in_process import drive_route
from husky_grader.run.standstill import STILL_SEC
from playpen_testing.processes import Process, Processes
from playpen_testing.shared_memory import Files, left, own_files
from playpen_testing.waiting import wait_until
import psutil
import pytest

ROOT = Path(__file__).resolve().parent.parent
LAB = str(ROOT / 'lab')
PARTS = {
    'simulator': '/husky_sim/husky_sim',
    'driver': '/husky_driver/follow_path',
    'view': '/husky_view/view',
    'launch': 'drive.launch.py',
    'lab': 'drive',
}

pytestmark = pytest.mark.timeout(120)


def family(run: Process) -> list[psutil.Process]:
    """Return a process that was started, and all that it has."""
    found = []
    for pid in tree(run.pid):
        with suppress(psutil.NoSuchProcess):  # it has just ended
            found.append(psutil.Process(pid))
    return found


def tree(pid: int) -> Iterator[int]:
    """Find descendants; psutil would ask every process of the machine who its parent is."""
    yield pid
    for thread in Path(f'/proc/{pid}/task').glob('*/children'):
        with suppress(OSError):  # it has just ended
            for child in thread.read_text().split():
                yield from tree(int(child))


def part(members: list[psutil.Process], mark: str) -> psutil.Process | None:
    """Return a part of a run; a node once it has loaded, and with that set its handlers."""
    for each in members:
        try:
            if mark in ' '.join(each.cmdline()) and (mark[0] != '/' or has_loaded(each)):
                return each
        except psutil.Error:  # it is just starting or ending
            continue
    return None


def has_loaded(node: psutil.Process) -> bool:
    # psutil would have the kernel count the pages of each library.
    try:
        return 'librcl.so' in Path(f'/proc/{node.pid}/maps').read_text()
    except OSError:  # it is just ending
        return False


def running(processes: list[psutil.Process]) -> list[str]:
    found = []
    for each in processes:
        try:
            if each.status() != psutil.STATUS_ZOMBIE:
                found.append(' '.join(each.cmdline()))
        except psutil.NoSuchProcess:
            continue
    return found


@pytest.mark.timeout(300)
def test_each_killed_part_ends_its_run_in_3_s_and_spoils_no_other(
    processes: Processes,
    tmp_path: Path,
    short_course: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    temporary = tmp_path / 'temporary'
    temporary.mkdir()
    monkeypatch.setenv('TMPDIR', str(temporary))
    shared = [kill_in_a_run(processes, tmp_path, name) for name in PARTS]
    again = ('--fast', '--no-view', '--waypoints', str(short_course))
    following = processes.start(LAB, 'drive', *again, '--report', str(tmp_path))
    assert following.wait(timeout_sec=60.0) == 0, following.output
    report = json.loads((tmp_path / 'report.json').read_text())
    undisturbed = read_run(drive_route(plan_route(load_course(short_course)))[0])
    assert report['trajectory_sha256'] == undisturbed.trajectory_sha256
    assert [file for files in shared for file in left(files)] == [], 'shared memory is left'
    files = [path.name for path in (*temporary.iterdir(), *tmp_path.glob('.*'))]
    # The parameters that a launch writes stay where it is killed itself, as Jazzy's do.
    assert [name for name in files if not name.startswith('launch_params_')] == []


def test_a_fast_drive_that_fails_after_it_stood_still_is_driven_again(
    processes: Processes, tmp_path: Path, short_course: Path
) -> None:
    """As after Ctrl-Z and `fg`, where its nodes miss each other 20 s later."""
    run = processes.start(
        LAB, 'drive', str(short_course), '--fast', '--no-view', '--report', str(tmp_path)
    )
    wait_until(
        lambda: part(family(run), PARTS['driver']) is not None,
        timeout_sec=40.0,
        what=lambda: f'the driver; it printed:\n{run.output}',
    )
    members = family(run)
    driver = part(members, PARTS['driver'])
    for each in members:
        each.suspend()
    time.sleep(STILL_SEC + 0.5)
    assert driver is not None
    driver.kill()
    for each in members:
        if each.pid != driver.pid:  # which its parent, once it runs again, takes note of
            each.resume()
    assert run.wait(timeout_sec=60.0) == 0, run.output
    assert 'driven again' in run.output
    report = json.loads((tmp_path / 'report.json').read_text())
    undisturbed = read_run(drive_route(plan_route(load_course(short_course)))[0])
    assert report['trajectory_sha256'] == undisturbed.trajectory_sha256


def kill_in_a_run(processes: Processes, folder: Path, name: str) -> Files:
    """Kill a part of a run, and wait for the end of the rest; return the run's shared memory."""
    options = () if name == 'view' else ('--no-view',)
    run = processes.start(LAB, 'drive', '--report', str(folder), *options)
    marks = [PARTS[each] for each in PARTS if each != 'view' or name == 'view']

    def has_all() -> bool:
        members = family(run)
        return all(part(members, mark) for mark in marks)

    wait_until(
        has_all,
        timeout_sec=40.0,
        what=lambda: f'all parts of a run, to kill its {name}; it printed:\n{run.output}',
    )
    members = family(run)
    victim = part(members, PARTS[name])
    assert victim is not None
    shared = own_files(each.pid for each in members)
    victim.send_signal(signal.SIGKILL)
    wait_until(
        lambda: not running(members),
        timeout_sec=3.0,
        what=lambda: f'the end of {running(members)} after its {name}; it printed:\n{run.output}',
    )
    assert 'Traceback' not in run.output, run.output
    return shared


@pytest.mark.parametrize('viewer', ['false', 'true'])
def test_a_killed_simulator_ends_its_launch(processes: Processes, viewer: str) -> None:
    launch = ('ros2', 'launch', 'husky_sim', 'husky_playpen.launch.py', f'viewer:={viewer}')
    run = processes.start(*launch)
    run.wait_for_text('34 obstacles')
    if viewer == 'true':  # it has what the simulator shares with it
        run.wait_for_text('look at http://')
    members = family(run)
    simulator = part(members, PARTS['simulator'])
    assert simulator is not None
    shared = own_files(each.pid for each in members)
    simulator.send_signal(signal.SIGKILL)
    wait_until(
        lambda: not running(members),
        timeout_sec=3.0,
        what=lambda: f'the end of {running(members)}; the launch printed:\n{run.output}',
    )
    assert left(shared) == [], 'shared memory is left'


def test_a_killed_view_leaves_nothing_when_its_launch_ends(processes: Processes) -> None:
    launch = ('ros2', 'launch', 'husky_sim', 'husky_playpen.launch.py', 'viewer:=true')
    run = processes.start(*launch)
    run.wait_for_text('look at http://')
    members = family(run)
    shared = own_files(each.pid for each in members)
    view = part(members, PARTS['view'])
    assert view is not None
    view.send_signal(signal.SIGKILL)
    run.wait_for_text('process has died')
    run.signal(signal.SIGINT)
    run.wait(timeout_sec=10.0)
    assert running(members) == []
    assert left(shared) == [], 'shared memory is left'


def test_an_interrupted_test_run_leaves_nothing(processes: Processes) -> None:
    tests = str(ROOT / 'test' / 'test_view_process.py')
    run = processes.start(LAB, 'test', tests)
    wait_until(
        lambda: part(family(run), PARTS['view']) is not None,
        timeout_sec=40.0,
        what=lambda: f'a view of the tests; they printed:\n{run.output}',
    )
    members = family(run)
    run.signal(signal.SIGINT)
    wait_until(
        lambda: not running(members),
        timeout_sec=2.0,
        what=lambda: f'the end of {running(members)}; the tests printed:\n{run.output}',
    )
    assert run.wait() == 130


def test_a_killed_test_run_leaves_no_browser(processes: Processes) -> None:
    run = processes.start(LAB, 'test', str(ROOT / 'test' / 'test_view.py'))
    wait_until(
        lambda: part(family(run), '--remote-debugging-pipe') is not None,
        timeout_sec=40.0,
        what=lambda: f'a browser of the tests; they printed:\n{run.output}',
    )
    members = family(run)
    run.signal(signal.SIGKILL)
    wait_until(
        lambda: not running(members),
        timeout_sec=3.0,
        what=lambda: f'the end of {running(members)}; the tests printed:\n{run.output}',
    )


DIES_ONCE = """
import os, pathlib, signal

def test_it():
    died = pathlib.Path(__file__).with_suffix('.died')
    if not died.exists():
        died.touch()
        os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_killed_test_process_fails_its_test_and_the_run_goes_on(
    processes: Processes, tmp_path: Path
) -> None:
    for number in range(20):
        text = DIES_ONCE if number == 15 else 'def test_it(): pass\n'
        (tmp_path / f'test_{number:02}.py').write_text(text)
    options = ['-p', 'conftest', '-c', '/dev/null', '--rootdir', str(tmp_path)]
    # Otherwise its end removes what earlier runs of all tests have left, which may take a minute.
    options += ['--basetemp', str(tmp_path / 'basetemp')]
    run = processes.start(
        *(sys.executable, '-m', 'pytest', *options, '--no-loadscope-reorder'),
        *('--numprocesses', '2', str(tmp_path)),
        cwd=ROOT,
    )
    assert run.wait(timeout_sec=30.0) == 1
    assert 'crashed while running' in run.output, run.output
    # The others of its file are run by another process, which is this one again.
    assert '1 failed, 20 passed' in run.output, run.output
