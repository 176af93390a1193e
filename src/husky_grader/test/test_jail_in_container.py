# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A jail where root may make no namespaces: the tests of jails once more, as in a container."""

from pathlib import Path
import subprocess
import sys

from playpen_testing.container import in_container
import pytest

SUBJECTS = ('', '_attacks', '_graph', '_watch')
FILES = [Path(__file__).with_name(f'test_jail{subject}.py') for subject in SUBJECTS]
FIND = 'from husky_grader.jail import find_sandbox; print(find_sandbox().name)'
GRADE = 'import sys; from husky_grader.grade import main; sys.exit(main())'
MANIFEST = """
<package format="3">
  <name>takes_a_name</name><version>0.0.0</version><description>-</description>
  <maintainer email="a@example.org">A</maintainer><license>Apache-2.0</license>
  <export><build_type>cmake</build_type></export>
</package>
"""
CMAKE = """
cmake_minimum_required(VERSION 3.19)
project(takes_a_name NONE)
execute_process(
  COMMAND python3 "${CMAKE_CURRENT_SOURCE_DIR}/take.py" COMMAND_ERROR_IS_FATAL ANY)
install(FILES take.py DESTINATION share/takes_a_name)
"""
# Two of them cannot have it at once.
TAKES_A_NAME = """
import socket, time
with socket.socket(socket.AF_UNIX) as taken:
    taken.bind('\\0{name}')
    time.sleep(1.5)
"""


def test_in_a_container_another_user_is_found() -> None:
    found = subprocess.run(
        in_container([sys.executable, '-c', FIND]), capture_output=True, text=True
    )
    assert found.stdout == 'user\n', found.stderr


@pytest.mark.timeout(180)
def test_a_jail_of_another_user_holds() -> None:
    tests = [sys.executable, '-m', 'pytest', '-k', 'user', *map(str, FILES)]
    done = subprocess.run(in_container(tests), capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    assert ' passed' in done.stdout


@pytest.mark.timeout(180)
def test_submissions_that_could_meet_run_one_at_a_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path / 'state'))
    rubric = tmp_path / 'rubric.yaml'
    rubric.write_text('title: names\nsteps:\n  - {kind: build, points: 1}\n')
    for place in ('class/ann', 'class/bob', 'cem'):
        package = tmp_path / place / 'src' / 'takes_a_name'
        package.mkdir(parents=True)
        (package / 'package.xml').write_text(MANIFEST)
        (package / 'CMakeLists.txt').write_text(CMAKE)
        (package / 'take.py').write_text(TAKES_A_NAME.format(name=tmp_path))
    calls = []
    for given in ('class', 'cem'):  # at once
        words = ['--lab', given, '--rubric', str(rubric), '--report', f'report of {given}']
        command = in_container([sys.executable, '-c', GRADE, *words, '--jobs', '2'])
        calls.append(
            subprocess.Popen(
                command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
            )
        )
    (table, told), (one, told_of_one) = [call.communicate() for call in calls]
    assert [call.returncode for call in calls] == [0, 0], table + told + one + told_of_one
    assert told.splitlines()[0] == (
        '--jobs 2: one is graded at a time, because the sandbox user lets programs reach those of '
        'other submissions'
    )
