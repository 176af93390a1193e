# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A disk without room costs a student nothing."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
import resource
import subprocess
import sys

from husky_grader.jail import find_sandbox
from husky_grader.lab.lab import grade_lab
from husky_grader.lab.room import check_room
from husky_grader.rubric.rubric_file import parse_rubric
import pytest

RUBRIC = parse_rubric('title: T\nsteps:\n  - {kind: build, points: 10}\n')
MANIFEST = """<package format="3">
  <name>p</name>
  <version>0.0.0</version>
  <description>It cannot be built</description>
  <maintainer email="somebody@example.org">Somebody</maintainer>
  <license>Apache-2.0</license>
  <export><build_type>ament_python</build_type></export>
</package>"""


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
    workspace, report = tmp_path / 'ws', tmp_path / 'report'
    (workspace / 'src' / 'p').mkdir(parents=True)
    (workspace / 'src' / 'p' / 'package.xml').write_text(MANIFEST)
    (workspace / 'src' / 'p' / 'setup.py').write_text('raise SystemExit("no such thing")\n')
    with files_of_at_most(1_000_000), pytest.raises(OSError) as caught:
        grade_lab(workspace, RUBRIC, report, sandbox=find_sandbox('none'))
    assert caught.value.filename == str(report)
    (grade,) = grade_lab(workspace, RUBRIC, report, sandbox=find_sandbox('none'))
    assert (grade.points, grade.why[:20]) == (0.0, 'colcon build failed:')


def test_a_place_where_no_program_runs_is_refused(tmp_path: Path) -> None:
    (tmp_path / 'ws' / 'src' / 'p').mkdir(parents=True)
    (tmp_path / 'ws' / 'src' / 'p' / 'package.xml').write_text(MANIFEST)
    mounts = ['unshare', '--map-root-user', '--mount', 'bash', '-c']
    noexec = f'mount -t tmpfs -o noexec tmpfs {tmp_path}/report'
    (tmp_path / 'report').mkdir()
    if subprocess.run([*mounts, noexec], capture_output=True).returncode != 0:
        pytest.skip('nothing can be mounted here')
    command = f'{sys.executable} -m husky_grader.grade --lab {tmp_path}/ws --sandbox none'
    graded = subprocess.run(
        [*mounts, f'{noexec} && exec {command} --report {tmp_path}/report/r'],
        capture_output=True,
        text=True,
    )
    assert (graded.returncode, graded.stderr) == (
        2,
        f'{tmp_path}/report/r: no program can run on this file system, which is mounted with '
        'noexec; name another folder with --report DIR\n',
    )
