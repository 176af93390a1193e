# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the computer cannot do costs a student nothing."""

from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import re
import resource
import shlex
import shutil
import subprocess
import sys

from husky_grader.grade import main as grade
from husky_grader.jail import find_sandbox, Jail
from husky_grader.lab.build_step import build_step, ColconMissing
from husky_grader.lab.lab import grade_lab
from husky_grader.lab.room import check_room
from husky_grader.playpen import config_folder
from husky_grader.rubric.rubric_file import load_rubric, parse_rubric
from husky_grader.rubric.steps import Step
import pytest

PATH_RUBRIC = config_folder() / 'rubrics' / 'path.yaml'
RUBRIC = parse_rubric('title: T\nsteps:\n  - {kind: build, points: 10}\n')
MANIFEST = """<package format="3">
  <name>p</name>
  <version>0.0.0</version>
  <description>It cannot be built</description>
  <maintainer email="somebody@example.org">Somebody</maintainer>
  <license>Apache-2.0</license>
  <export><build_type>ament_python</build_type></export>
</package>"""
CMAKE = """
cmake_minimum_required(VERSION 3.8)
project(p NONE)
install(PROGRAMS drive DESTINATION lib/p)
"""
DRIVE = """
title: T
steps:
  - {kind: build, points: 10}
  - {kind: drive, points: 90, package: p, executable: drive, courses: [{file: course.yaml}]}
"""
PUBLISH = """\
  - {kind: publisher, points: 10, package: p, executable: drive, topic: t,
     type: std_msgs/msg/String}
"""


def write_workspace(folder: Path) -> Path:
    """Write a workspace with a package that cannot be built; return it."""
    package = folder / 'src' / 'p'
    package.mkdir(parents=True)
    (package / 'package.xml').write_text(MANIFEST)
    (package / 'setup.py').write_text('raise SystemExit("no such thing")\n')
    return folder


def write_driver(folder: Path, program: str) -> None:
    """Write a workspace that can be built, ws, with a program that is to drive course.yaml."""
    package = write_workspace(folder / 'ws') / 'src' / 'p'
    (package / 'CMakeLists.txt').write_text(CMAKE)
    (package / 'package.xml').write_text(MANIFEST.replace('ament_python', 'cmake'))
    (package / 'drive').write_text(program)
    (folder / 'course.yaml').write_text('waypoints: [[0, 0], [-1, 0]]\n')


@contextmanager
def files_of_at_most(most_bytes: int) -> Iterator[None]:
    """Let a write fail here as it does on a disk that is nearly full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_folder_without_room_is_named(tmp_path: Path) -> None:
    check_room(tmp_path)
    with files_of_at_most(1_000_000), pytest.raises(OSError) as caught:
        check_room(tmp_path)
    assert caught.value.filename == str(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_what_fails_without_room_is_not_the_fault_of_a_student(tmp_path: Path) -> None:
    workspace, report = write_workspace(tmp_path / 'ws'), tmp_path / 'report'
    with files_of_at_most(1_000_000), pytest.raises(OSError) as caught:
        grade_lab(workspace, RUBRIC, report, sandbox=find_sandbox('none'))
    assert caught.value.filename == str(report)
    (grade,) = grade_lab(workspace, RUBRIC, report, sandbox=find_sandbox('none'))
    assert (grade.points, grade.why[:20]) == (0.0, 'colcon build failed:')


def test_a_place_where_no_program_runs_is_refused(tmp_path: Path) -> None:
    write_workspace(tmp_path / 'ws')
    (tmp_path / 'report').mkdir()
    mount = f'mount -t tmpfs -o noexec tmpfs {tmp_path}/report'
    command = f'{sys.executable} -m husky_grader.grade --lab {tmp_path}/ws --sandbox none'
    graded = subprocess.run(
        [
            *('unshare', '--map-root-user', '--mount', 'bash', '-c'),
            f'{mount} && exec {command} --report {tmp_path}/report/r',
        ],
        capture_output=True,
        text=True,
    )
    assert (graded.returncode, graded.stderr) == (
        2,
        f'{tmp_path}/report/r: no program can run on this file system, which is mounted with '
        'noexec; name another folder with --report DIR\n',
    )


def test_a_disk_that_is_full_amid_a_drive_is_told(tmp_path: Path, courses: Path) -> None:
    (tmp_path / 'report').mkdir()
    (tmp_path / 'driver.py').write_text(
        'import time\nfrom geometry_msgs.msg import Twist\nimport rclpy\nrclpy.init()\n'
        "publisher = rclpy.create_node('driver').create_publisher(\n"
        "    Twist, 'husky_velocity_controller/cmd_vel', 10)\n"
        'while True:\n    publisher.publish(Twist())\n    time.sleep(0.1)\n'
    )
    mount = f'mount -t tmpfs -o size=32k tmpfs {tmp_path}/report'
    words = [sys.executable, '-m', 'husky_grader.grade', '--report', f'{tmp_path}/report/r']
    words += ['--controller', f'{sys.executable} {tmp_path}/driver.py']
    words += ['--waypoints', str(courses / 'straight.yaml')]
    graded = subprocess.run(
        [
            *('unshare', '--map-root-user', '--mount', 'bash', '-c'),
            f'{mount} && exec {shlex.join(words)}',
        ],
        capture_output=True,
        text=True,
    )
    assert graded.returncode == 2, graded
    assert graded.stderr.startswith('the simulator died: '), graded.stderr
    assert 'No space left on device' in graded.stderr
    assert graded.stderr.endswith('; see r/simulator.log\n')


@pytest.mark.parametrize('given', [[], ['--rubric', str(PATH_RUBRIC), '--lab']])
def test_a_class_is_not_graded_where_nothing_can_be_written(
    given: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ('ann', 'bob'):
        (tmp_path / f'{name}.yaml').write_text('waypoints: [[0, 0], [-1, 0]]\n')
    files = [str(tmp_path / f'{name}.yaml') for name in ('ann', 'bob')]
    assert grade([*given, *files, '--report', '/proc/self']) == 2  # nor can root
    told = capsys.readouterr()
    assert told.out == ''
    name_another = 'name another folder with --report DIR\n'
    assert re.fullmatch(
        rf'/proc/self: nothing can be written there \(.*\); {name_another}', told.err
    )


@pytest.mark.parametrize('char', ':${}"`*')
def test_a_report_where_nothing_can_be_built_is_refused(
    tmp_path: Path, char: str, capsys: pytest.CaptureFixture[str]
) -> None:
    write_workspace(tmp_path / 'ws')
    report = tmp_path / f'a{char}b'
    words = ['--lab', str(tmp_path / 'ws'), '--sandbox', 'none', '--report', str(report)]
    assert grade(words) == 2
    assert capsys.readouterr().err == (
        f"{report}: nothing can be built in a folder with a '{char}' in its name; name another "
        'folder with --report DIR\n'
    )
    assert not report.exists()


def test_a_report_in_a_folder_that_is_not_utf8_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_workspace(tmp_path / 'ws')
    folder = tmp_path / os.fsdecode(b'a\xff')
    words = ['--lab', str(tmp_path / 'ws'), '--sandbox', 'none', '--report', str(folder / 'r')]
    assert grade(words) == 2
    assert capsys.readouterr().err == (
        f'{tmp_path}/a\\xff/r: nothing can be built in a folder whose name is not UTF-8; name '
        'another folder with --report DIR\n'
    )
    assert not folder.exists()


def test_a_folder_of_a_person_is_not_taken_for_what_is_built(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    workspace = write_workspace(tmp_path / 'ws')
    (tmp_path / 'rubric.yaml').write_text('title: T\nsteps:\n  - {kind: build, points: 10}\n')
    (kept := tmp_path / 'report' / 'built' / 'kept').parent.mkdir(parents=True)
    kept.touch()
    words = ['--lab', str(workspace), '--rubric', str(tmp_path / 'rubric.yaml')]
    words += ['--sandbox', 'none', '--report', str(tmp_path / 'report')]
    assert grade(words) == 2
    assert capsys.readouterr().err == (
        f'--report {tmp_path}/report: {kept.parent} is not of the grader, which would build there '
        'and remove it; name another folder\n'
    )
    kept.rename(tmp_path / 'kept')
    assert grade(words) == 1
    kept.parent.mkdir()
    (tmp_path / 'kept').rename(kept)  # as one that was killed while it removed what it built
    assert grade(words) == 1
    assert not kept.parent.exists()


def test_a_missing_colcon_is_not_the_fault_of_a_student(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = write_workspace(tmp_path / 'ws')
    (tmp_path / 'built').mkdir()
    (tmp_path / 'bin').mkdir()
    (tmp_path / 'bin' / 'env').symlink_to(shutil.which('env') or '')
    monkeypatch.setenv('PATH', f'{tmp_path}/bin')
    with (
        Jail(find_sandbox('none'), tmp_path / 'built') as jail,
        pytest.raises(ColconMissing, match='colcon cannot be started; install it, or if it is'),
    ):
        build_step(workspace, jail, tmp_path / 'log')


def test_a_simulator_that_does_not_start_is_told_to_who_grades(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_driver(tmp_path, '')
    (tmp_path / 'rubric.yaml').write_text(DRIVE)
    monkeypatch.setenv('RMW_IMPLEMENTATION', 'rmw_of_nobody')
    with pytest.raises(ValueError, match='the simulator did not start: '):
        grade_lab(
            tmp_path / 'ws',
            load_rubric(tmp_path / 'rubric.yaml'),
            tmp_path / 'report',
            sandbox=find_sandbox('none'),
        )


def test_a_build_that_the_kernel_ends_is_told_of_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = write_workspace(tmp_path / 'ws')
    (tmp_path / 'built').mkdir()
    colcon = tmp_path / 'bin' / 'colcon'
    colcon.parent.mkdir()
    colcon.write_text('#!/bin/sh\necho "Starting >>> p"\nkill -KILL $$\n')
    colcon.chmod(0o755)
    monkeypatch.setenv('PATH', f'{colcon.parent}:{os.environ["PATH"]}')
    with Jail(find_sandbox('none'), tmp_path / 'built') as jail:
        found = build_step(workspace, jail, tmp_path / 'log')
    killed = 'SIGKILL, as by the kernel where memory runs out'
    assert (found.score, found.why) == (0.0, f'colcon build failed: {killed}')


@pytest.mark.timeout(60)
def test_a_job_is_alive_amid_each_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """However much time the watch over programs takes there: else it would be ended."""
    write_driver(tmp_path, '#!/bin/sh\nsleep 2\n')
    monkeypatch.setattr('husky_grader.lab.build_step.ALIVE_EVERY_SEC', 0.05)
    calls: list[None] = []
    amid: dict[str, int] = {}

    def done(step: Step) -> None:
        amid[step.name] = len(calls)
        calls.clear()

    steps = grade_lab(
        tmp_path / 'ws',
        parse_rubric(DRIVE + PUBLISH, str(tmp_path / 'rubric.yaml')),
        tmp_path / 'report',
        sandbox=find_sandbox('none'),
        done=done,
        alive=lambda: calls.append(None),
    )
    assert [step.points for step in steps] == [10.0, 0.0, 0.0], steps
    # Once is after the step before.
    assert {name: count > 1 for name, count in amid.items()} == dict.fromkeys(amid, True), amid
    assert [*amid] == ['build', 'drive', 'publisher']
