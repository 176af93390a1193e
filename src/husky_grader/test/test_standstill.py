# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A grader that was stopped while it graded, with SIGSTOP, and what it does again."""

import itertools
import os
from pathlib import Path
import signal
import subprocess
import sys
from textwrap import indent
import time

from husky_grader.run.standstill import MOST_TIMES, STILL_SEC, undisturbed
from playpen_testing.processes import Child
import pytest

ATTEMPT = """
import sys
from husky_grader.run.standstill import undisturbed
def attempt():
    print('attempt', flush=True)
    word = sys.stdin.readline().strip()
    if word == 'fail':
        raise ValueError('failed')
    return word
print('result', undisturbed(attempt), flush=True)
"""
# Started first, it stops the grader for a while; what the grader started then comes to nothing.
STOPS_ONCE = f"""
import os, signal, sys, time
from pathlib import Path
import psutil
grader, first = int(Path({{pid!r}}).read_text()), Path({{first!r}})
this = psutil.Process()
(started,) = (str(each.pid) for each in (this, *this.parents()) if each.ppid() == grader)
if not first.exists():
    first.write_text(started)
    os.kill(grader, signal.SIGSTOP)
    time.sleep({STILL_SEC + 0.5})
    os.kill(grader, signal.SIGCONT)
if first.read_text() == started:
    sys.exit('stopped it')
"""
FOLLOWS = """
from husky_driver.follow_path import main
sys.exit(main(['follow_path', '--waypoints', 'course.yaml']))
"""
GRADES = """
import os, sys
from pathlib import Path
Path(sys.argv.pop(1)).write_text(str(os.getpid()))
from husky_grader.grade import main
sys.exit(main(sys.argv[1:]))
"""
GRADES_A_BUILD = """
from dataclasses import replace
import os, sys
from pathlib import Path
Path(sys.argv[1]).write_text(str(os.getpid()))
from husky_grader.jail import find_sandbox
from husky_grader.lab.lab import grade_lab
from husky_grader.playpen import default_rubric
from husky_grader.rubric.rubric_file import load_rubric
from husky_grader.rubric.steps import BuildStep, Rubric
(step,) = (s for s in load_rubric(default_rubric()).steps if isinstance(s, BuildStep))
rubric = Rubric(title='a build', steps=(replace(step, needs=(), needs_one_of=()),))
workspace, folder = map(Path, sys.argv[2:])
(grade,) = grade_lab(workspace, rubric, folder, sandbox=find_sandbox('none'))
print(grade.points, 'of', grade.most, grade.why)
"""
SETUP = """
from setuptools import setup
import sys
setup(name='small', version='0.0.1', packages=[])
if '--dry-run' not in sys.argv:  # as colcon asks what it is
"""


@pytest.mark.parametrize('words', [['fail', 'other'], ['one', 'other'], ['one', 'fail']])
def test_what_came_of_an_attempt_amid_which_it_stood_still_does_not_count(
    words: list[str],
) -> None:
    command = [sys.executable, '-c', ATTEMPT]
    pipe = subprocess.PIPE
    with Child(command, stdin=pipe, stdout=pipe, stderr=pipe) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stdout.readline() == 'attempt\n'
        process.send_signal(signal.SIGSTOP)
        time.sleep(STILL_SEC + 0.5)
        process.send_signal(signal.SIGCONT)
        process.stdin.write(f'{words[0]}\n')
        process.stdin.flush()
        assert process.stdout.readline() == 'attempt\n'
        out, error = process.communicate(f'{words[1]}\n', timeout=20.0)
    assert out == ('' if words[1] == 'fail' else f'result {words[1]}\n'), error
    assert ('ValueError: failed' in error) == (words[1] == 'fail')


def test_without_a_standstill_there_is_one_attempt() -> None:
    attempts = itertools.count(1)

    def attempt() -> int:
        time.sleep(0.3)
        return next(attempts)

    assert undisturbed(attempt) == 1


def test_there_is_an_end_to_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('husky_grader.run.standstill.STILL_SEC', -1.0)
    attempts = itertools.count(1)
    assert undisturbed(lambda: next(attempts)) == MOST_TIMES


@pytest.fixture
def stops_once(tmp_path: Path) -> str:
    """Return a program that stops the grader once; its process writes `pid`."""
    return STOPS_ONCE.format(first=str(tmp_path / 'first'), pid=str(tmp_path / 'pid'))


def test_a_drive_amid_which_the_computer_stood_still_is_driven_again(
    tmp_path: Path, courses: Path, stops_once: str
) -> None:
    (tmp_path / 'driver.py').write_text(stops_once + FOLLOWS)
    course = 'speed: 0.5\nwaypoints: [[0, 0], [-0.5, 0.2]]\n'
    (tmp_path / 'course.yaml').write_text(course)
    options = ['--controller', f'{sys.executable} driver.py', '--waypoints', 'course.yaml']
    environment = {
        **os.environ,
        'PYTHONPATH': ':'.join(sys.path),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'FASTRTPS_DEFAULT_PROFILES_FILE': str(courses.parent / 'fastdds.xml'),
    }
    command = [sys.executable, '-c', GRADES, str(tmp_path / 'pid'), *options]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=60.0
    )
    assert (tmp_path / 'first').exists(), done.stderr
    assert done.returncode == 0, done.stdout + done.stderr
    assert 'score 100.0 of 100' in done.stdout


def test_a_step_of_a_lab_amid_which_the_computer_stood_still_is_judged_again(
    tmp_path: Path, stops_once: str
) -> None:
    package = tmp_path / 'CSE461_01' / 'src' / 'small'
    package.mkdir(parents=True)
    (package / 'package.xml').write_text(
        '<package format="3"><name>small</name><version>0.0.1</version>'
        '<description>x</description><maintainer email="a@b.c">a</maintainer><license>x</license>'
        '<export><build_type>ament_python</build_type></export></package>'
    )
    (package / 'setup.py').write_text(SETUP + indent(stops_once, '    '))
    folders = [str(tmp_path / 'CSE461_01'), str(tmp_path / 'report')]
    command = [sys.executable, '-c', GRADES_A_BUILD, str(tmp_path / 'pid'), *folders]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60.0)
    assert (tmp_path / 'first').exists(), done.stderr
    points, _, most, why = done.stdout.split(' ', 3)
    assert points == most, why
